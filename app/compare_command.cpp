#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/values.h"
#include "render/compare.h"
#include "render/exr.h"
#include "scene/glb_writer.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

struct CompareFlags {
  std::string picture, reference;
  std::optional<std::string> reference2, mask, output;
};

std::string Percent(double fraction) { return Format("%.2f %%", 100 * fraction); }

std::string Text(const Comparison& c) {
  std::string text =
      "pixel error " + Percent(c.pixel_error) + ", block error " + Percent(c.block_error) + "\n";
  if (c.reference_pixel_noise) {
    text += "noise of one reference: pixel " + Percent(*c.reference_pixel_noise) + ", block " +
            Percent(*c.reference_block_noise) + " (it cancels in the errors; 0 means below it)\n";
  }
  return text + "mean " + Short(c.mean) + " against " + Short(c.reference_mean) + ", " +
         Count(c.pixels, "pixel") + " compared\n";
}

ExitCode RunCompare(const CompareFlags& flags, Console& console) {
  if (flags.output) {
    RequireExtension("-o", *flags.output, {".png"});
    if (flags.mask) RequireOtherFile("-o", *flags.output, *flags.mask, "the mask");
    CheckWritable(*flags.output);
  }
  const Image picture = ReadExr(flags.picture), reference = ReadExr(flags.reference);
  std::optional<Image> reference2;
  if (flags.reference2) reference2 = ReadExr(*flags.reference2);
  std::optional<Mask> mask;
  if (flags.mask) mask = ReadPngMask(*flags.mask);

  Comparison c;
  try {
    c = Compare(picture, reference, reference2 ? &*reference2 : nullptr, mask ? &*mask : nullptr);
    if (flags.output) {
      Image middle = reference;  // with two references the difference is to their mean
      for (size_t i = 0; reference2 && i < middle.pixels.size(); ++i) {
        middle.pixels[i] = 0.5f * (reference.pixels[i] + reference2->pixels[i]);
      }
      WritePng(DifferencePicture(picture, middle, mask ? &*mask : nullptr), 0, *flags.output);
      console.Say("wrote " + *flags.output + ": |difference| over the mean, pale yellow from " +
                  Percent(kDifferenceFullScale));
    }
  } catch (const InputError& e) {
    throw InputError(flags.picture + " against " + flags.reference + ": " + e.what());
  }

  nlohmann::json json = {{"pixel_error", c.pixel_error},
                         {"block_error", c.block_error},
                         {"mean", c.mean},
                         {"reference_mean", c.reference_mean},
                         {"pixels", c.pixels}};
  if (c.reference_pixel_noise) {
    json["reference_pixel_noise"] = *c.reference_pixel_noise;
    json["reference_block_noise"] = *c.reference_block_noise;
  }
  console.Result(Text(c), json);
  return kDone;
}

}  // namespace

void AddCompareCommand(CLI::App& app, Command* command) {
  auto flags = std::make_shared<CompareFlags>();
  CLI::App* compare = app.add_subcommand("compare", "Error of a picture against a reference or two");
  compare->footer(
      "Pixel error: rms(A - REF) / mean(REF) over all channels of the unmasked pixels. Block error: the same "
      "after\n"
      "averaging 8 x 8 pixels, which shows bias without the noise. With two independent noisy references r "
      "and s\n"
      "the squared error is mean((a - r)(a - s)), in which their noise cancels, and it is printed beside "
      "it.\n"
      "\n"
      "Examples:\n"
      "  lobe compare view.exr reference.exr\n"
      "  lobe compare view.exr reference.a.exr reference.b.exr --mask lamps.png -o difference.png");
  compare->add_option("A", flags->picture, "Picture, OpenEXR")->type_name("")->required();
  compare->add_option("REF", flags->reference, "Reference, OpenEXR of the same size")
      ->type_name("")
      ->required();
  compare->add_option("REF2", flags->reference2, "Second, independent reference")->type_name("");
  compare->add_option("--mask", flags->mask, "PNG of the same size; white pixels are left out")
      ->type_name("FILE");
  compare->add_option("-o,--output", flags->output, "False-colour difference to write, .png")
      ->type_name("FILE");
  compare->callback(
      [flags, command] { *command = [flags](Console& console) { return RunCompare(*flags, console); }; });
}

}  // namespace lobe
