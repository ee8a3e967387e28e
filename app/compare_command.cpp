#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/values.h"
#include "render/compare.h"
#include "render/exr.h"
#include "render/flip.h"
#include "scene/glb_writer.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

struct CompareFlags {
  std::string picture, reference, layout = "side-by-side", tone = "srgb";
  std::optional<std::string> reference2, mask, output, layer;
  float exposure = 0;
  double pixels_per_degree = kFlipPixelsPerDegree;
};

/// What the files held.
struct Pictures {
  Image picture, reference;
  std::optional<Image> reference2;
  std::optional<Mask> mask;
  bool colour = true;  ///< all of them: light or reflectance, which can be shown

  const Image* second() const { return reference2 ? &*reference2 : nullptr; }
  const Mask* left_out() const { return mask ? &*mask : nullptr; }
};

/// The figures, and FLIP where there is something to see.
struct Figures {
  Comparison c;
  std::optional<double> flip;
};

std::string Percent(double fraction) { return Format("%.2f %%", 100 * fraction); }

/// Everything that can be said without opening a file.
void Validate(const CompareFlags& flags) {
  if (flags.output) {
    RequireExtension("-o", *flags.output, {".png"});
    if (flags.mask) RequireOtherFile("-o", *flags.output, *flags.mask, "the mask");
    CheckWritable(*flags.output);
  }
  if (flags.layout != "side-by-side" && flags.layout != "map") {
    throw UsageError("--layout: '" + flags.layout + "' is unknown; 'side-by-side' or 'map' is expected");
  }
  ParseTone("--tone", flags.tone);
  RequireExposure("--exposure", flags.exposure);
  if (!(flags.pixels_per_degree >= kFlipMinPixelsPerDegree &&
        flags.pixels_per_degree <= kFlipMaxPixelsPerDegree)) {
    throw UsageError("--pixels-per-degree: " + Short(flags.pixels_per_degree) +
                     " is out of range: " + Short(kFlipMinPixelsPerDegree) + " to " +
                     Short(kFlipMaxPixelsPerDegree) + " is expected");
  }
}

/// Of the layer Z: pixels where no picture hits anything say nothing and would say it loudly.
void LeaveOutBackground(Pictures* p) {
  Mask background{p->picture.width, p->picture.height, {}};
  const auto far = [](const Image& image, size_t i) { return image.pixels[i][0] >= kBackgroundDepth; };
  for (size_t i = 0; i < p->picture.pixels.size(); ++i) {
    background.set.push_back((p->mask && p->mask->set[i]) || (far(p->picture, i) && far(p->reference, i) &&
                                                              (!p->reference2 || far(*p->reference2, i))));
  }
  p->mask = background;
}

/// Where a crop lies in its full picture; nothing if it is no crop, or lies elsewhere.
std::optional<PixelRect> PlaceOfCrop(const ExrWindows& windows) {
  const PixelRect &data = windows.data, &full = windows.display;
  const bool inside = data.x0 >= full.x0 && data.y0 >= full.y0 && data.x1 <= full.x1 && data.y1 <= full.y1;
  if (data == full || !inside) return std::nullopt;
  return PixelRect{data.x0 - full.x0, data.y0 - full.y0, data.x1 - full.x0, data.y1 - full.y0};
}

Mask Part(const Mask& mask, const PixelRect& rect) {
  Mask part{rect.width(), rect.height(), {}};
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) part.set.push_back(mask.set[size_t(y) * mask.width + x]);
  }
  return part;
}

/// A crop is compared with its part of full references and masks.
void CutToCrop(const CompareFlags& flags, Pictures* p) {
  const std::string& path = flags.picture;
  const ExrWindows windows = ReadExrWindows(path);
  const std::optional<PixelRect> rect = PlaceOfCrop(windows);
  if (!rect) return;
  const auto require_same_place = [&](const std::string& other) {
    const std::optional<PixelRect> theirs = PlaceOfCrop(ReadExrWindows(other));
    if (!theirs || *theirs == *rect) return;
    const auto corner = [](const PixelRect& r) {
      return "(" + std::to_string(r.x0) + ", " + std::to_string(r.y0) + ")";
    };
    throw InputError(other + ": is a crop that begins at pixel " + corner(*theirs) + ", and " + path +
                     " one that begins at " + corner(*rect) + "; the same crop is expected");
  };
  require_same_place(flags.reference);
  if (flags.reference2) require_same_place(*flags.reference2);
  const auto cut = [&](auto* whole) {
    if (whole->width == windows.display.width() && whole->height == windows.display.height()) {
      *whole = Part(*whole, *rect);
    }
  };
  cut(&p->reference);
  if (p->reference2) cut(&*p->reference2);
  if (p->mask) cut(&*p->mask);
}

Pictures Read(const CompareFlags& flags) {
  Pictures p;
  const auto read = [&](const std::string& path) {
    if (!flags.layer) return ReadExr(path);
    ExrLayer layer = ReadExrLayer(path, *flags.layer);
    p.colour = p.colour && layer.colour;
    return std::move(layer.image);
  };
  p.picture = read(flags.picture);
  p.reference = read(flags.reference);
  if (flags.reference2) p.reference2 = read(*flags.reference2);
  if (flags.mask) p.mask = ReadPngMask(*flags.mask);
  CutToCrop(flags, &p);
  return p;
}

Figures Measure(const CompareFlags& flags, Pictures* p) {
  const ErrorScale scale = p->colour ? ErrorScale::kMean : ErrorScale::kMeanAbsolute;
  if (flags.layer == LayerName(Layer::kDepth)) {
    const auto equal = [&](const auto& other) {
      return other.width == p->picture.width && other.height == p->picture.height;
    };
    // Sizes that differ are Compare's to refuse.
    if (equal(p->reference) && (!p->reference2 || equal(*p->reference2)) && (!p->mask || equal(*p->mask))) {
      LeaveOutBackground(p);
    }
  }
  Figures f{Compare(p->picture, p->reference, p->second(), p->left_out(), scale), std::nullopt};
  if (p->colour) {
    f.flip = MeanFlip(p->picture, MiddleOf(p->reference, p->second()), p->left_out(), flags.exposure,
                      ParseTone("--tone", flags.tone), flags.pixels_per_degree);
  }
  return f;
}

void Draw(const CompareFlags& flags, const Pictures& p, const Comparison& c, const Console& console) {
  const ToneCurve curve = ParseTone("--tone", flags.tone);
  const Image middle = MiddleOf(p.reference, p.second());  // with two references: their mean
  const Image map = DifferencePicture(p.picture, middle, p.left_out(), c.scale);
  const std::string legend = "|difference| over the mean, pale yellow from " + Percent(kDifferenceFullScale);
  if (flags.layout == "map") {
    WritePng(map, 0, *flags.output);
    console.Say("wrote " + *flags.output + ": " + legend);
    return;
  }
  const Image shown = ToneMapped(p.picture, flags.exposure, curve),
              shown_reference = ToneMapped(middle, flags.exposure, curve);
  WritePng(SideBySide({&shown, &shown_reference, &map}), 0, *flags.output);
  console.Say("wrote " + *flags.output + ": picture, reference, " + legend);
}

std::string Text(const CompareFlags& flags, const Figures& f) {
  const Comparison& c = f.c;
  std::string text =
      "pixel error " + Percent(c.pixel_error) + ", block error " + Percent(c.block_error) + "\n";
  text += "relMSE " + Short(c.relative_mse) + ", bias of the mean " + Format("%+.2f %%", 100 * c.bias) + "\n";
  text += "relative error of a pixel: median " + Percent(c.relative_error.p50) + ", 90th percentile " +
          Percent(c.relative_error.p90) + ", 99th " + Percent(c.relative_error.p99) + ", largest " +
          Percent(c.relative_error.max) + "\n";
  if (f.flip) {
    text += "FLIP " + Format("%.4f", *f.flip) + " (tone " + flags.tone + ", exposure " +
            Short(flags.exposure) + ", " + Short(flags.pixels_per_degree) + " pixels per degree)\n";
  }
  if (c.reference_pixel_noise) {
    text += "noise of one reference: pixel " + Percent(*c.reference_pixel_noise) + ", block " +
            Percent(*c.reference_block_noise) +
            " (it cancels in pixel and block error and relMSE; 0 means below it)\n";
  } else {
    text += "one reference: whatever noise it has is included; a second, independent one takes it out\n";
  }
  return text + "mean " + Short(c.mean) + " against " + Short(c.reference_mean) + ", " +
         Count(c.pixels, "pixel") + " compared\n";
}

nlohmann::json Json(const CompareFlags& flags, const Figures& f) {
  const Comparison& c = f.c;
  nlohmann::json json = {{"pixel_error", c.pixel_error},
                         {"block_error", c.block_error},
                         {"relative_mse", c.relative_mse},
                         {"relative_mse_epsilon", kRelMseEpsilon * c.scale * c.scale},
                         {"bias", c.bias},
                         {"relative_error",
                          {{"p50", c.relative_error.p50},
                           {"p90", c.relative_error.p90},
                           {"p99", c.relative_error.p99},
                           {"max", c.relative_error.max}}},
                         {"mean", c.mean},
                         {"reference_mean", c.reference_mean},
                         {"scale", c.scale},
                         {"includes_reference_noise", !c.reference_pixel_noise},
                         {"pixels", c.pixels}};
  if (flags.layer) json["layer"] = *flags.layer;
  if (f.flip) {
    json["flip"] = {{"mean", *f.flip},
                    {"tone", flags.tone},
                    {"exposure", flags.exposure},
                    {"pixels_per_degree", flags.pixels_per_degree}};
  }
  if (c.reference_pixel_noise) {
    json["reference_pixel_noise"] = *c.reference_pixel_noise;
    json["reference_block_noise"] = *c.reference_block_noise;
  }
  if (flags.output) json["output"] = *flags.output;
  return json;
}

ExitCode RunCompare(const CompareFlags& flags, Console& console) {
  Validate(flags);
  Pictures pictures = Read(flags);
  Figures figures;
  try {
    figures = Measure(flags, &pictures);
  } catch (const InputError& e) {
    throw InputError(flags.picture + " against " + flags.reference + ": " + e.what());
  }
  if (figures.c.reference_pixel_noise == 0.0) {
    console.Warn(
        "the two references are equal, so their noise does not cancel; independent ones are expected");
  }
  if (flags.output) Draw(flags, pictures, figures.c, console);
  console.Result(Text(flags, figures), Json(flags, figures));
  return kDone;
}

}  // namespace

void AddCompareCommand(CLI::App& app, Command* command) {
  auto flags = std::make_shared<CompareFlags>();
  CLI::App* compare = app.add_subcommand("compare", "Error of a picture against a reference or two");
  compare->footer(
      "Pixel error: rms(A - REF) / mean(REF) over all channels of the unmasked pixels. Block error: the "
      "same\n"
      "after averaging 8 x 8 pixels, which shows bias without the noise. relMSE: mean((a - r)^2 / (r^2 + "
      "e)),\n"
      "e = 0.01 mean(REF)^2; a pixel's relative error is the root of its share. Bias: of the mean, over it.\n"
      "FLIP (Andersson et al., HPG 2020): what an observer sees of the difference when both are shown by\n"
      "--tone at --exposure, 0 to 1; with two references against their mean.\n"
      "\n"
      "With ONE reference its noise is included in every figure. With two independent ones r and s the\n"
      "squared errors are means of (a - r)(a - s), in which their noise cancels; it is printed beside them.\n"
      "\n"
      "Examples:\n"
      "  lobe compare view.exr reference.exr\n"
      "  lobe compare view.exr reference.a.exr reference.b.exr --mask lamps.png -o difference.png\n"
      "  lobe compare view.exr reference.exr --layer albedo --layout map -o difference.png\n"
      "  lobe compare dark.exr reference.exr --exposure 3 --tone filmic --json");
  compare->add_option("A", flags->picture, "Picture, OpenEXR")->type_name("")->required();
  compare
      ->add_option("REF", flags->reference,
                   "Reference, OpenEXR of the same size, or the whole that A is a crop of")
      ->type_name("")
      ->required();
  compare->add_option("REF2", flags->reference2, "Second, independent reference")->type_name("");
  compare->add_option("--mask", flags->mask, "PNG of the same size; white pixels are left out")
      ->type_name("FILE");
  compare
      ->add_option("--layer", flags->layer,
                   "Compare this layer of the files, such as albedo, N, Z or direct [R, G, B]; of Z, pixels "
                   "that hit nothing in any file are left out")
      ->type_name("NAME");
  compare
      ->add_option("-o,--output", flags->output,
                   "PNG to write: picture, reference and false-colour difference side by side")
      ->type_name("FILE");
  compare->add_option("--layout", flags->layout, "Of that PNG: side-by-side, or map for the difference alone")
      ->type_name("NAME")
      ->capture_default_str();
  compare->add_option("--exposure", flags->exposure, "Of FLIP and the PNG, in stops: values times 2^EV")
      ->type_name("EV")
      ->capture_default_str();
  compare->add_option("--tone", flags->tone, "Of FLIP and the PNG: srgb (cut at 1), reinhard or filmic")
      ->type_name("NAME")
      ->capture_default_str();
  compare
      ->add_option("--pixels-per-degree", flags->pixels_per_degree,
                   "Of FLIP: how fine the observer sees; 67 is a 4K screen 0.7 m wide from 0.7 m")
      ->type_name("X")
      ->capture_default_str();
  compare->callback(
      [flags, command] { *command = [flags](Console& console) { return RunCompare(*flags, console); }; });
}

}  // namespace lobe
