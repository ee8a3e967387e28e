#include <algorithm>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/picture_source.h"
#include "app/progress.h"
#include "app/render_outputs.h"
#include "app/render_views.h"
#include "app/report.h"
#include "app/values.h"
#include "render/emitter_mask.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

struct RenderFlags {
  std::string solution, mode = "auto", filter = "box";
  std::optional<std::string> layers;
  RenderViews views;
  RenderOutputs outputs;
  RenderOptions options;

  // From the flags, once checked.
  bool path_traced = false, unconverged = false;
  LayerSet layer_set;
};

constexpr struct {
  const char* name;
  RenderMode mode;
} kModes[] = {{"stored", RenderMode::kStored},
              {"direct", RenderMode::kDirect},
              {"gather", RenderMode::kGather},
              {"auto", RenderMode::kAuto}};

/// Everything that can be said without reading the solution.
void Validate(RenderFlags* flags) {
  flags->views.Validate();
  flags->path_traced = flags->mode == "path";
  if (!flags->path_traced) {
    const auto mode = std::find_if(std::begin(kModes), std::end(kModes),
                                   [&](const auto& m) { return flags->mode == m.name; });
    if (mode == std::end(kModes)) {
      throw UsageError("--mode: '" + flags->mode +
                       "' is unknown; 'stored', 'direct', 'gather', 'auto' or 'path' is expected");
    }
    flags->options.mode = mode->mode;
  }
  if (flags->options.gather_base && flags->mode != "gather") {
    throw UsageError("--gather-base belongs to --mode gather, not " + flags->mode);
  }
  if (flags->layers) {
    if (!flags->outputs.wants_exr())
      throw UsageError("--layers: no output is an .exr file, which can hold them");
    if (flags->path_traced) throw UsageError("--layers: mode path has no layers");
    std::string wrong;
    const auto layers = ParseLayers(*flags->layers, &wrong);
    if (!layers) throw UsageError("--layers: " + wrong);
    flags->layer_set = *layers;
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
                           {"samplesPerPixel", report.samples_per_pixel},
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
                         {"height", view.size.height}, {"samples_per_pixel", report.samples_per_pixel},
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
              Format("%.3g million rays", double(report.rays) * 1e-6) + Format(", %.2f s", report.seconds) +
              Format("; clamped %.2g %%", 100 * report.clamped) +
              Format(", by mirrors and glass not followed %.2g %%", 100 * report.cut_off));
}

ExitCode RunRender(RenderFlags flags, Console& console) {
  Validate(&flags);
  const std::atomic<bool>* interrupted = CatchInterrupts();
  const PictureSource source(flags.solution, flags.path_traced, flags.unconverged);  // shared by all views
  if (const std::string sentence = source.TrustSentence(); !sentence.empty()) {
    console.Warn(flags.solution + ": " + sentence);
  }
  const std::vector<RenderView> views = flags.views.Choose(source.scene());
  const std::vector<ViewFiles> files = flags.outputs.FilesOf(views, flags.solution);

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
      image = source.Render(seen, options, flags.layer_set, &report, [&](double fraction) {
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
      flags.outputs.WriteMask(EmitterMask(source.scene(), source.tracer(), seen, options), files[i], console);
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
      "Mirrors and glass are traced from the eye. What else it meets shows the light that --mode finds:\n"
      "  stored  the stored lobes, as they are: fastest\n"
      "  direct  lamps are sampled anew at every eye ray's end, for crisp shadows; the rest is stored\n"
      "  gather  gloss is traced until it meets stored light; the diffuse base is stored\n"
      "  auto    gather for gloss too sharp for its lobes (`lobe info`), stored for everything else\n"
      "  path    no lobes: an unbiased path tracer, of scenes too; noisy, and right in the mean\n"
      "Without --camera and --eye the first camera of the file is used. Many views in one go read the "
      "solution\n"
      "once; interrupted, the finished ones are kept (exit code 3).\n"
      "\n"
      "Examples:\n"
      "  lobe render solution.glb --camera view0 -o view.exr\n"
      "  lobe render solution.glb --camera view0 -o view.exr -o view.png --size 1280x720 --spp 64 --exposure "
      "1\n"
      "  lobe render scene.glb --mode path --spp 1024 -o reference.exr\n"
      "  lobe render solution.glb --layers albedo,N,Z,direct,indirect,specular -o layers.exr\n"
      "  lobe render solution.glb --eye 1,1.6,3 --target 0,1,0 --fov 60 -o view.png --tone filmic\n"
      "  lobe render solution.glb --camera view0 --size 1920x1080 --crop 800,400,1000,500 -o detail.exr\n"
      "  lobe render solution.glb --all-cameras -o '{camera}.exr' --mask '{camera}.mask.png'\n"
      "  lobe render solution.glb --camera-path flight.json --frames 120 -o 'flight_{frame}.png'");
  render->add_option("SOLUTION", flags->solution, "Solution written by `lobe solve`; a scene, in mode path")
      ->type_name("")
      ->required();
  flags->outputs.AddTo(render);
  flags->views.AddTo(render);
  render->add_option("--spp", flags->options.samples_per_pixel, "Eye rays per pixel, rounded up to a square")
      ->type_name("N")
      ->capture_default_str();
  render->add_option("--mode", flags->mode, "How light is found: stored, direct, gather, auto or path")
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
  render
      ->add_option("--layers", flags->layers,
                   "Layers of .exr files beside the colour: all, or of albedo,N,P,Z,direct,indirect,"
                   "specular,clamped")
      ->type_name("LIST");
  render->add_option("--filter", flags->filter, "Pixel filter: box or blackman-harris (radius 1.5 pixels)")
      ->type_name("NAME")
      ->capture_default_str();
  render
      ->add_option("--max-mirror-depth", flags->options.max_mirror_depth,
                   "Mirrors and glass surfaces in a row that are followed")
      ->type_name("N")
      ->capture_default_str();
  render
      ->add_option(
          "--specular-cutoff", flags->options.specular_cutoff,
          "Least throughput with which ways by mirrors and glass are followed on; what that costs is "
          "printed")
      ->type_name("X")
      ->capture_default_str();
  render->add_flag("--unconverged", flags->unconverged,
                   "Render a solution that did not converge, too; else it is refused, since its light means "
                   "nothing");
  AddSeedFlag(render, &flags->options.seed);
  render->callback(
      [flags, command] { *command = [flags](Console& console) { return RunRender(*flags, console); }; });
}

}  // namespace lobe
