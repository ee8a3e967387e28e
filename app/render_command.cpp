#include <memory>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "app/render_outputs.h"
#include "app/render_views.h"
#include "app/report.h"
#include "app/values.h"
#include "render/emitter_mask.h"
#include "render/renderer.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

struct RenderFlags {
  std::string solution, mode = "stored", filter = "box";
  RenderViews views;
  RenderOutputs outputs;
  RenderOptions options;
};

/// Everything that can be said without reading the solution.
void Validate(RenderFlags* flags) {
  flags->views.Validate();
  if (flags->mode != "stored") {
    throw UsageError("--mode: '" + flags->mode + "' is unknown; 'stored' is expected");
  }
  if (flags->filter == "blackman-harris") {
    flags->options.filter = PixelFilter::kBlackmanHarris;
  } else if (flags->filter != "box") {
    throw UsageError("--filter: '" + flags->filter + "' is unknown; 'box' or 'blackman-harris' is expected");
  }
  if (const std::string wrong = flags->options.Validate(); !wrong.empty()) throw UsageError(wrong);
  flags->outputs.Validate(flags->views);
  flags->views.ReadFiles();
}

ExrAttributes Attributes(const RenderFlags& flags, const RenderView& view, const CameraView& seen,
                         const RenderReport& report) {
  ExrAttributes attributes{{"worldToCamera", seen.WorldToCamera()},
                           {"worldToNDC", seen.WorldToNdc()},
                           {"lobeVersion", std::string(LOBE_VERSION)},
                           {"lobeMode", flags.mode},
                           {"lobeFilter", flags.filter},
                           {"lobeSolution", flags.solution},
                           {"lobeComplete", report.complete ? 1 : 0},
                           {"samplesPerPixel", flags.options.samples_per_pixel},
                           {"renderSeconds", float(report.seconds)}};
  if (view.frame) {
    attributes["lobeFrame"] = *view.frame;
  } else {
    attributes["camera"] = view.camera.name;
  }
  return attributes;
}

nlohmann::json ViewJson(const RenderFlags& flags, const RenderView& view, const ViewFiles& files,
                        const RenderReport& report) {
  nlohmann::json json = {{"outputs", files.pictures},  {"width", view.size.width},
                         {"height", view.size.height}, {"samples_per_pixel", flags.options.samples_per_pixel},
                         {"mode", flags.mode},         {"filter", flags.filter},
                         {"seconds", report.seconds},  {"rays", report.rays},
                         {"clamped", report.clamped},  {"cut_off", report.cut_off},
                         {"complete", report.complete}};
  if (view.frame) {
    json["frame"] = *view.frame;
  } else {
    json["camera"] = view.camera.name;
  }
  if (files.mask) json["mask"] = *files.mask;
  if (view.crop != PixelRect{}) {
    json["crop"] = {view.crop.x0, view.crop.y0, view.crop.x1, view.crop.y1};
  }
  return json;
}

void SayFigures(const RenderOptions& options, const RenderReport& report, const Console& console) {
  const PixelRect window = options.Window();
  console.Say(std::to_string(window.width()) + " x " + std::to_string(window.height()) + " pixels, " +
              Format("%.3g million eye rays and mirrors", double(report.rays) * 1e-6) +
              Format(", %.2f s", report.seconds) + Format("; clamped %.2g %%", 100 * report.clamped) +
              Format(", behind too many mirrors %.2g %%", 100 * report.cut_off));
}

ExitCode RunRender(RenderFlags flags, Console& console) {
  Validate(&flags);
  const std::atomic<bool>* interrupted = CatchInterrupts();
  const Solution solution = ReadSolution(flags.solution);
  const std::vector<RenderView> views = flags.views.Choose(solution.scene);
  const std::vector<ViewFiles> files = flags.outputs.FilesOf(views, flags.solution);
  const Renderer renderer(solution);  // shared by all views

  nlohmann::json finished = nlohmann::json::array();
  bool complete = true;
  for (size_t i = 0; i < views.size() && complete; ++i) {
    const RenderView& view = views[i];
    RenderOptions options = flags.options;
    options.width = view.size.width;
    options.height = view.size.height;
    options.crop = view.crop;
    const CameraView seen(view.camera, options.width, options.height);

    RenderReport report;
    LayeredImage image;
    {
      ProgressDisplay display(console);
      const std::string words =
          "rendering " + view.words +
          (views.size() > 1 ? ", " + std::to_string(i + 1) + " of " + std::to_string(views.size()) : "");
      image.color = renderer.Render(seen, options, &report, [&](double fraction) {
        display.Show((double(i) + fraction) / double(views.size()), words);
        return !interrupted->load();
      });
    }
    // Of many pictures an unfinished one is worth nothing: it would look like the others. A single one is
    // all there is.
    complete = report.complete;
    if (!complete && flags.views.several()) break;
    flags.outputs.Write(image, Attributes(flags, view, seen, report), view, files[i], console);
    if (flags.outputs.wants_mask()) {
      flags.outputs.WriteMask(EmitterMask(solution.scene, renderer.tracer(), seen, options), files[i],
                              console);
    }
    SayFigures(options, report, console);
    finished.push_back(ViewJson(flags, view, files[i], report));
    if (i + 1 < views.size() && interrupted->load()) complete = false;
  }

  if (console.json()) {
    if (flags.views.several()) {
      console.Result("", {{"views", finished}, {"asked", views.size()}, {"complete", complete}});
    } else {
      console.Result("", finished.at(0));
    }
  }
  if (complete) return kDone;
  PrintError(flags.views.several() ? "interrupted; " + std::to_string(finished.size()) + " of " +
                                         Count(views.size(), "view") + " finished and kept"
                                   : "interrupted; the picture was saved with its unfinished pixels black");
  return kStoppedEarly;
}

}  // namespace

void AddRenderCommand(CLI::App& app, Command* command) {
  auto flags = std::make_shared<RenderFlags>();
  CLI::App* render = app.add_subcommand("render", "Render views of a solution");
  render->footer(
      "Reads the stored lobes towards the eye at every hit; mirrors are traced. Without --camera and --eye "
      "the\n"
      "first camera of the file is used. Many views in one go read the solution once; interrupted, the\n"
      "finished ones are kept (exit code 3).\n"
      "\n"
      "Examples:\n"
      "  lobe render solution.glb --camera view0 -o view.exr\n"
      "  lobe render solution.glb --camera view0 -o view.exr -o view.png --size 1280x720 --spp 64 --exposure "
      "1\n"
      "  lobe render solution.glb --eye 1,1.6,3 --target 0,1,0 --fov 60 -o view.png --tone filmic\n"
      "  lobe render solution.glb --camera view0 --size 1920x1080 --crop 800,400,1000,500 -o detail.exr\n"
      "  lobe render solution.glb --all-cameras -o '{camera}.exr' --mask '{camera}.mask.png'\n"
      "  lobe render solution.glb --camera-path flight.json --frames 120 -o 'flight_{frame}.png'");
  render->add_option("SOLUTION", flags->solution, "Solution written by `lobe solve`")
      ->type_name("")
      ->required();
  flags->outputs.AddTo(render);
  flags->views.AddTo(render);
  render->add_option("--spp", flags->options.samples_per_pixel, "Eye rays per pixel, rounded up to a square")
      ->type_name("N")
      ->capture_default_str();
  render->add_option("--mode", flags->mode, "How light is read: stored")
      ->type_name("NAME")
      ->capture_default_str();
  render->add_option("--filter", flags->filter, "Pixel filter: box or blackman-harris (radius 1.5 pixels)")
      ->type_name("NAME")
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
