#include <memory>
#include <numbers>
#include <optional>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "app/report.h"
#include "app/values.h"
#include "render/exr.h"
#include "render/png.h"
#include "render/renderer.h"
#include "scene/glb_writer.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

constexpr double kDefaultFov = 40;  ///< degrees, with --eye (chosen)

struct RenderFlags {
  std::string solution, camera, mode = "stored", filter = "box";
  std::vector<std::string> outputs;
  std::string size, eye, target, up;
  double fov_degrees = 0;
  bool has_fov = false;
  float exposure = 0;
  RenderOptions options;

  // From the flags, once checked.
  std::optional<PictureSize> picture_size;
  std::optional<Camera> free_camera;
};

/// Everything that can be said without opening a file.
void Validate(RenderFlags* flags) {
  for (const std::string& output : flags->outputs) RequireExtension("-o", output, {".exr", ".png"});
  if (!flags->size.empty()) flags->picture_size = ParseSize("--size", flags->size);
  if (flags->mode != "stored")
    throw UsageError("--mode: '" + flags->mode + "' is unknown; 'stored' is expected");
  if (flags->filter == "blackman-harris") {
    flags->options.filter = PixelFilter::kBlackmanHarris;
  } else if (flags->filter != "box") {
    throw UsageError("--filter: '" + flags->filter + "' is unknown; 'box' or 'blackman-harris' is expected");
  }
  if (!std::isfinite(flags->exposure)) throw UsageError("--exposure: a finite number of stops is expected");
  if (const std::string wrong = flags->options.Validate(); !wrong.empty()) throw UsageError(wrong);
  if (flags->has_fov && !(flags->fov_degrees > 0 && flags->fov_degrees < 180)) {
    throw UsageError("--fov: " + Short(flags->fov_degrees) +
                     " is out of range: degrees between 0 and 180 are expected");
  }
  if (flags->eye.empty()) {
    if (!flags->target.empty() || !flags->up.empty())
      throw UsageError("--target and --up belong to --eye, which is missing");
    return;
  }
  if (!flags->camera.empty())
    throw UsageError("--camera and --eye exclude each other; one of them is expected");
  if (flags->target.empty()) throw UsageError("--eye needs --target, the point to look at");
  const Vec3 up = flags->up.empty() ? Vec3(0, 1, 0) : ParseVector("--up", flags->up);
  const double fov = (flags->has_fov ? flags->fov_degrees : kDefaultFov) * std::numbers::pi / 180;
  try {
    flags->free_camera =
        LookAt(ParseVector("--eye", flags->eye), ParseVector("--target", flags->target), up, float(fov));
  } catch (const InputError& e) {
    throw UsageError(e.what());  // these values came from flags
  }
}

Camera ChooseCamera(const RenderFlags& flags, const Scene& scene) {
  if (flags.free_camera) return *flags.free_camera;
  if (flags.camera.empty() && scene.cameras.empty()) {
    throw InputError(scene.path +
                     ": has no camera; --eye and --target are expected to say where to look from");
  }
  Camera camera = flags.camera.empty() ? scene.cameras.front() : scene.FindCamera(flags.camera);
  if (flags.has_fov) camera.fov_y = float(flags.fov_degrees * std::numbers::pi / 180);
  return camera;
}

ExrAttributes Attributes(const RenderFlags& flags, const CameraView& view, const RenderReport& report) {
  return {{"worldToCamera", view.WorldToCamera()},
          {"worldToNDC", view.WorldToNdc()},
          {"lobeVersion", std::string(LOBE_VERSION)},
          {"lobeMode", flags.mode},
          {"lobeFilter", flags.filter},
          {"lobeSolution", flags.solution},
          {"lobeComplete", report.complete ? 1 : 0},
          {"camera", view.camera().name},
          {"samplesPerPixel", flags.options.samples_per_pixel},
          {"renderSeconds", float(report.seconds)}};
}

nlohmann::json RenderJson(const RenderFlags& flags, const CameraView& view, const RenderReport& report,
                          const RenderOptions& options) {
  return {{"outputs", flags.outputs},
          {"camera", view.camera().name},
          {"width", options.width},
          {"height", options.height},
          {"samples_per_pixel", options.samples_per_pixel},
          {"mode", flags.mode},
          {"filter", flags.filter},
          {"seconds", report.seconds},
          {"rays", report.rays},
          {"clamped", report.clamped},
          {"cut_off", report.cut_off},
          {"complete", report.complete}};
}

ExitCode RunRender(RenderFlags flags, Console& console) {
  Validate(&flags);
  for (const std::string& output : flags.outputs) CheckWritable(output);
  const std::atomic<bool>* interrupted = CatchInterrupts();

  const Solution solution = ReadSolution(flags.solution);
  const Camera camera = ChooseCamera(flags, solution.scene);
  const PictureSize size = flags.picture_size.value_or(DefaultSize(camera));
  RenderOptions options = flags.options;
  options.width = size.width;
  options.height = size.height;
  const CameraView view(camera, options.width, options.height);

  RenderReport report;
  const Image image = [&] {
    ProgressDisplay display(console);
    return Renderer(solution).Render(view, options, &report, [&](double fraction) {
      display.Show(fraction, "rendering '" + camera.name + "'");
      return !interrupted->load();
    });
  }();

  for (const std::string& output : flags.outputs) {
    if (Extension(output) == ".exr") {
      WriteExr(image, Attributes(flags, view, report), output);
    } else {
      WritePng(image, flags.exposure, output);
    }
    console.Say("wrote " + output);
  }
  console.Say(std::to_string(options.width) + " x " + std::to_string(options.height) + " pixels, " +
              Format("%.3g million eye rays and mirrors", double(report.rays) * 1e-6) +
              Format(", %.2f s", report.seconds) + Format("; clamped %.2g %%", 100 * report.clamped) +
              Format(", behind too many mirrors %.2g %%", 100 * report.cut_off));
  if (console.json()) console.Result("", RenderJson(flags, view, report, options));
  if (report.complete) return kDone;
  PrintError("interrupted; the picture was saved with its unfinished pixels black");
  return kStoppedEarly;
}

}  // namespace

void AddRenderCommand(CLI::App& app, Command* command) {
  auto flags = std::make_shared<RenderFlags>();
  CLI::App* render = app.add_subcommand("render", "Render a view of a solution");
  render->footer(
      "Reads the stored lobes towards the eye at every hit; mirrors are traced. Without --camera and --eye "
      "the\n"
      "first camera of the file is used.\n"
      "\n"
      "Examples:\n"
      "  lobe render solution.glb --camera view0 -o view.exr\n"
      "  lobe render solution.glb --camera view0 -o view.exr -o view.png --size 1280x720 --spp 64 --exposure "
      "1\n"
      "  lobe render solution.glb --eye 1,1.6,3 --target 0,1,0 --fov 60 -o view.png");
  render->add_option("SOLUTION", flags->solution, "Solution written by `lobe solve`")
      ->type_name("")
      ->required();
  render
      ->add_option("-o,--output", flags->outputs,
                   "Picture to write, .exr (scene-linear) or .png (sRGB); may be repeated")
      ->type_name("FILE")
      ->required()
      ->allow_extra_args(false);
  render->add_option("--camera", flags->camera, "Camera of the file, by name [the first]")->type_name("NAME");
  render
      ->add_option("--size", flags->size,
                   "Picture size in pixels, such as 640x480 [512 high, the camera's aspect]")
      ->type_name("WxH");
  render->add_option("--spp", flags->options.samples_per_pixel, "Eye rays per pixel, rounded up to a square")
      ->type_name("N")
      ->capture_default_str();
  render->add_option("--mode", flags->mode, "How light is read: stored")
      ->type_name("NAME")
      ->capture_default_str();
  render->add_option("--filter", flags->filter, "Pixel filter: box or blackman-harris (radius 1.5 pixels)")
      ->type_name("NAME")
      ->capture_default_str();
  render->add_option("--exposure", flags->exposure, "Of PNG pictures, in stops: values times 2^EV")
      ->type_name("EV")
      ->capture_default_str();
  render->add_option("--eye", flags->eye, "A camera of your own: where it stands, X,Y,Z in metres")
      ->type_name("X,Y,Z");
  render->add_option("--target", flags->target, "The point it looks at, X,Y,Z in metres")->type_name("X,Y,Z");
  render->add_option("--up", flags->up, "The direction that is up in the picture, X,Y,Z [0,1,0]")
      ->type_name("X,Y,Z");
  CLI::Option* fov = render
                         ->add_option("--fov", flags->fov_degrees,
                                      "Vertical field of view, degrees [the camera's; 40 with --eye]")
                         ->type_name("DEG");
  render
      ->add_option("--max-mirror-depth", flags->options.max_mirror_depth,
                   "Mirrors in a row that are followed")
      ->type_name("N")
      ->capture_default_str();
  render->add_option("--seed", flags->options.seed, "Seed of the eye rays; the same seed gives the same bits")
      ->type_name("N")
      ->capture_default_str();
  render->callback([flags, command, fov] {
    flags->has_fov = fov->count() > 0;
    *command = [flags](Console& console) { return RunRender(*flags, console); };
  });
}

}  // namespace lobe
