#include <algorithm>
#include <cmath>
#include <memory>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "app/report.h"
#include "app/values.h"
#include "app/view_flags.h"
#include "render/exr.h"
#include "render/png.h"
#include "render/renderer.h"
#include "scene/glb_writer.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

struct RenderFlags {
  std::string solution, mode = "auto", filter = "box";
  std::vector<std::string> outputs;
  ViewFlags view;
  float exposure = 0;
  RenderOptions options;
};

constexpr struct {
  const char* name;
  RenderMode mode;
} kModes[] = {{"stored", RenderMode::kStored},
              {"direct", RenderMode::kDirect},
              {"gather", RenderMode::kGather},
              {"auto", RenderMode::kAuto}};

/// Everything that can be said without opening a file.
void Validate(RenderFlags* flags) {
  for (const std::string& output : flags->outputs) RequireExtension("-o", output, {".exr", ".png"});
  flags->view.Validate();
  const auto mode = std::find_if(std::begin(kModes), std::end(kModes),
                                 [&](const auto& m) { return flags->mode == m.name; });
  if (mode == std::end(kModes)) {
    throw UsageError("--mode: '" + flags->mode +
                     "' is unknown; 'stored', 'direct', 'gather' or 'auto' is expected");
  }
  flags->options.mode = mode->mode;
  if (flags->filter == "blackman-harris") {
    flags->options.filter = PixelFilter::kBlackmanHarris;
  } else if (flags->filter != "box") {
    throw UsageError("--filter: '" + flags->filter + "' is unknown; 'box' or 'blackman-harris' is expected");
  }
  if (!std::isfinite(flags->exposure)) throw UsageError("--exposure: a finite number of stops is expected");
  if (const std::string wrong = flags->options.Validate(); !wrong.empty()) throw UsageError(wrong);
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
  const Camera camera = flags.view.ChooseCamera(solution.scene);
  const PictureSize size = flags.view.ChooseSize(camera);
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
  flags->view.AddTo(render);
  render->add_option("--spp", flags->options.samples_per_pixel, "Eye rays per pixel, rounded up to a square")
      ->type_name("N")
      ->capture_default_str();
  render->add_option("--mode", flags->mode, "How light is found: stored, direct, gather or auto")
      ->type_name("NAME")
      ->capture_default_str();
  render
      ->add_option("--light-samples", flags->options.light_samples,
                   "Lamp samples per eye ray, in mode direct")
      ->type_name("N")
      ->capture_default_str();
  render
      ->add_option("--gather-samples", flags->options.gather_samples,
                   "Directions traced per eye ray where gloss is gathered")
      ->type_name("N")
      ->capture_default_str();
  render->add_flag("--gather-base", flags->options.gather_base,
                   "In mode gather: trace the diffuse base too, of every material");
  render->add_option("--filter", flags->filter, "Pixel filter: box or blackman-harris (radius 1.5 pixels)")
      ->type_name("NAME")
      ->capture_default_str();
  render->add_option("--exposure", flags->exposure, "Of PNG pictures, in stops: values times 2^EV")
      ->type_name("EV")
      ->capture_default_str();
  render
      ->add_option("--max-mirror-depth", flags->options.max_mirror_depth,
                   "Mirrors in a row that are followed")
      ->type_name("N")
      ->capture_default_str();
  AddSeedFlag(render, &flags->options.seed);
  render->callback(
      [flags, command] { *command = [flags](Console& console) { return RunRender(*flags, console); }; });
}

}  // namespace lobe
