// Layers, half precision and windows of OpenEXR files.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/exr.h"
#include "scene/input_error.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace lobe {
namespace {

using test::ExpectInputError;
using test::ScratchFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Every value differs from every other, in layers, channels and pixels.
LayeredImage Distinct(int width, int height, const LayerSet& layers) {
  LayeredImage image(width, height, layers);
  float next = 0.125f;
  const auto fill = [&](Image& plane) {
    for (Rgb& p : plane.pixels) {
      for (int c = 0; c < 3; ++c) p[c] = next = next + 0.37f;
    }
  };
  fill(image.color);
  for (auto& [layer, plane] : image.layers) fill(plane);
  return image;
}

void ExpectEqual(const Image& a, const Image& b, const std::string& what) {
  ASSERT_EQ(a.width, b.width) << what;
  ASSERT_EQ(a.height, b.height) << what;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    ASSERT_TRUE((a.pixels[i] == b.pixels[i]).all()) << what << ", pixel " << i;
  }
}

/// Runs an OpenEXR tool; its output, or nothing where it is not installed.
std::optional<std::string> RunTool(const std::string& tool, const std::string& path, int* status) {
  if (std::system(("command -v " + tool + " > /dev/null 2>&1").c_str()) != 0) return std::nullopt;
  FILE* pipe = popen((tool + " '" + path + "' 2>&1").c_str(), "r");
  std::string text;
  char buffer[512];
  while (pipe && std::fgets(buffer, sizeof buffer, pipe)) text += buffer;
  *status = pclose(pipe);
  return text;
}

TEST(ExrLayersTest, EveryLayerComesBackExactly) {
  const ScratchFolder folder;
  const LayeredImage image = Distinct(13, 7, LayerSet::All());
  EXPECT_EQ(WriteExr(image, {}, {}, folder.File("a.exr")).clamped, 0u);
  ExpectEqual(ReadExr(folder.File("a.exr")), image.color, "colours");
  for (const auto& [layer, plane] : image.layers) {
    const ExrLayer read = ReadExrLayer(folder.File("a.exr"), LayerName(layer));
    EXPECT_EQ(read.colour, IsColour(layer)) << LayerName(layer);
    Image expected = plane;
    if (layer == Layer::kDepth) {
      for (Rgb& p : expected.pixels) p.setConstant(p[0]);
    }
    ExpectEqual(read.image, expected, LayerName(layer));
  }
  EXPECT_THAT(ListExrLayers(folder.File("a.exr")),
              UnorderedElementsAre("albedo", "N", "P", "Z", "direct", "indirect", "specular", "clamped"));
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"a.exr"}) << "no temporary file stays";
}

TEST(ExrLayersTest, OnlyWantedLayersAreThere) {
  const ScratchFolder folder;
  std::string wrong;
  WriteExr(LayeredImage(3, 3, *ParseLayers("Z,albedo", &wrong)), {}, {}, folder.File("a.exr"));
  EXPECT_THAT(ListExrLayers(folder.File("a.exr")), UnorderedElementsAre("Z", "albedo"));
  ExpectInputError([&] { ReadExrLayer(folder.File("a.exr"), "direct"); },
                   {"a.exr", "no layer 'direct'", "found: ", "Z", "albedo"});
  WriteExr(Image(2, 2), {}, folder.File("b.exr"));
  EXPECT_THAT(ListExrLayers(folder.File("b.exr")), ElementsAre());
  ExpectInputError([&] { ReadExrLayer(folder.File("b.exr"), "N"); }, {"no layer 'N'", "none"});
}

// Half keeps 11 significant bits: relative error at most 2^-11.
TEST(ExrLayersTest, HalfIsForColoursAlone) {
  const ScratchFolder folder;
  const LayeredImage image = Distinct(9, 9, LayerSet::All());
  EXPECT_EQ(WriteExr(image, {}, {.half_colours = true}, folder.File("a.exr")).clamped, 0u);
  const auto near = [](const Image& a, const Image& b) {
    bool exact = true;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
      EXPECT_TRUE(((a.pixels[i] - b.pixels[i]).abs() <= b.pixels[i].abs() / 2048).all()) << i;
      exact = exact && (a.pixels[i] == b.pixels[i]).all();
    }
    return exact;
  };
  EXPECT_FALSE(near(ReadExr(folder.File("a.exr")), image.color));
  for (const auto& [layer, plane] : image.layers) {
    if (layer == Layer::kDepth) continue;
    const Image read = ReadExrLayer(folder.File("a.exr"), LayerName(layer)).image;
    EXPECT_EQ(near(read, plane), !IsColour(layer)) << LayerName(layer);
  }
}

TEST(ExrLayersTest, WhatHalfCannotHoldIsClampedAndCounted) {
  const ScratchFolder folder;
  LayeredImage image(4, 1, {});
  image.color.at(0, 0) = Rgb(65504, 65505, 1e30f);
  image.color.at(1, 0) = Rgb(-70000, kInfinity, -kInfinity);
  image.color.at(2, 0) = Rgb(std::nanf(""), 1, 65503);
  EXPECT_EQ(WriteExr(image, {}, {.half_colours = true}, folder.File("a.exr")).clamped, 5u);
  const Image read = ReadExr(folder.File("a.exr"));
  EXPECT_TRUE((read.at(0, 0) == Rgb(65504, 65504, 65504)).all());
  EXPECT_TRUE((read.at(1, 0) == Rgb(-65504, 65504, -65504)).all());
  EXPECT_TRUE(std::isnan(read.at(2, 0)[0]));
  EXPECT_EQ(read.at(2, 0)[2], 65504) << "rounded to the nearest half, not counted";
  EXPECT_EQ(WriteExr(image, {}, {}, folder.File("b.exr")).clamped, 0u);
  EXPECT_EQ(ReadExr(folder.File("b.exr")).at(1, 0)[1], kInfinity) << "float keeps it";
}

TEST(ExrLayersTest, NothingHitIsFarAwayAndElseZero) {
  const ScratchFolder folder;
  WriteExr(LayeredImage(2, 2, LayerSet::All()), {}, {.half_colours = true}, folder.File("a.exr"));
  for (const Layer layer : kAllLayers) {
    const Rgb value = ReadExrLayer(folder.File("a.exr"), LayerName(layer)).image.at(1, 1);
    EXPECT_TRUE((value == (layer == Layer::kDepth ? kBackgroundDepth : 0)).all()) << LayerName(layer);
  }
}

TEST(ExrLayersTest, ACropIsADataWindowInsideTheDisplayWindow) {
  const ScratchFolder folder;
  const LayeredImage image = Distinct(5, 4, LayerSet::All());
  for (const bool half : {false, true}) {
    WriteExr(image, {}, {.half_colours = half, .full_width = 40, .full_height = 30, .left = 11, .top = 7},
             folder.File("a.exr"));
    const ExrWindows windows = ReadExrWindows(folder.File("a.exr"));
    EXPECT_EQ(windows.data, (PixelRect{11, 7, 16, 11}));
    EXPECT_EQ(windows.display, (PixelRect{0, 0, 40, 30}));
    ExpectEqual(ReadExrLayer(folder.File("a.exr"), "P").image, image.layers.at(Layer::kPosition), "P");
    if (!half) ExpectEqual(ReadExr(folder.File("a.exr")), image.color, "colours");
  }
  EXPECT_THROW(WriteExr(image, {}, {.full_width = 15, .full_height = 30, .left = 11}, folder.File("b.exr")),
               std::invalid_argument);
  EXPECT_THROW(ReadExr(folder.File("b.exr")), InputError) << "nothing was written";
}

TEST(ExrLayersTest, LayersOfAnotherSizeAreRefused) {
  const ScratchFolder folder;
  LayeredImage image(4, 4, {});
  image.layers[Layer::kAlbedo] = Image(4, 3);
  EXPECT_THROW(WriteExr(image, {}, {}, folder.File("a.exr")), std::invalid_argument);
  EXPECT_TRUE(folder.Entries().empty());
}

// OpenEXR's own tools, as a second opinion (Debian: openexr).
TEST(ExrLayersTest, OpenExrsOwnToolsAcceptTheFile) {
  const ScratchFolder folder;
  WriteExr(Distinct(33, 17, LayerSet::All()), {{"lobeMode", std::string("stored")}},
           {.half_colours = true, .full_width = 64, .full_height = 64, .left = 3, .top = 5},
           folder.File("a.exr"));
  int status = 0;
  const auto header = RunTool("exrheader", folder.File("a.exr"), &status);
  if (!header) GTEST_SKIP() << "exrheader is not installed";
  EXPECT_EQ(status, 0) << *header;
  for (const char* part :
       {"albedo.R, 16-bit floating-point", "N.X, 32-bit floating-point", "P.Z, 32-bit floating-point",
        "Z, 32-bit floating-point", "clamped.B, 16-bit floating-point", "(3 5) - (35 21)", "(0 0) - (63 63)",
        "chromaticities", "lobeMode"}) {
    EXPECT_THAT(*header, HasSubstr(part));
  }
  if (const auto check =
          RunTool("exrcheck", folder.File("a.exr"), &status)) {  // since OpenEXR 3.0, not everywhere
    EXPECT_EQ(status, 0) << *check;
  }
}

TEST(LayersTest, ListsAreParsedAndWrongNamesNamed) {
  std::string wrong;
  LayerSet two;
  two.Add(Layer::kNormal);
  two.Add(Layer::kDepth);
  EXPECT_EQ(ParseLayers("Z,N", &wrong), two);
  EXPECT_EQ(ParseLayers("all", &wrong), LayerSet::All());
  EXPECT_EQ(ParseLayers("albedo,N,P,Z,direct,indirect,specular,clamped", &wrong), LayerSet::All());
  for (const std::string text : {"", "Z,", ",Z", "Z,,N", "z", "Z,depth", "all,Z"}) {
    wrong.clear();
    EXPECT_FALSE(ParseLayers(text, &wrong)) << text;
    EXPECT_THAT(wrong, HasSubstr("is no layer; albedo, N, P, Z, direct")) << text;
  }
  EXPECT_FALSE(ParseLayers("Z,N,Z", &wrong));
  EXPECT_THAT(wrong, HasSubstr("'Z' is given twice"));
}

}  // namespace
}  // namespace lobe
