#include "render/png.h"

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "scene/input_error.h"
#include "tests/support/scratch_folder.h"

namespace lobe {
namespace {

using test::ReadWholeFile;
using test::ScratchFolder;
using test::WriteWholeFile;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string ErrorOf(const std::string& path) {
  try {
    ReadPngMask(path);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

/// A 4 x 1 PNG of any bit depth and colour type by libpng's classic interface, which render/ does not use.
void WriteRow(const std::string& path, int depth, int colour_type, std::vector<unsigned char> row,
              const std::vector<png_color>& palette = {}) {
  FILE* file = std::fopen(path.c_str(), "wb");
  ASSERT_NE(file, nullptr);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, 4, 1, depth, colour_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (!palette.empty()) png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  png_write_info(png, info);
  png_write_row(png, row.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

/// 8-bit RGB by libpng's simplified reader.
std::vector<unsigned char> ReadRgb(const std::string& path, int* width, int* height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_file(&image, path.c_str())) << image.message;
  image.format = PNG_FORMAT_RGB;
  std::vector<unsigned char> rgb(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr)) << image.message;
  *width = int(image.width);
  *height = int(image.height);
  return rgb;
}

TEST(PngTest, WritesSrgbBytesRowByRow) {
  const ScratchFolder folder;
  Image image(3, 2);
  image.at(0, 0) = Rgb(0.18f, 0, 1);
  image.at(2, 1) = Rgb(0.5f, 0.25f, -1);
  WritePng(image, 0.0f, folder.File("a.png"));
  int width = 0, height = 0;
  const auto rgb = ReadRgb(folder.File("a.png"), &width, &height);
  ASSERT_EQ(width, 3);
  ASSERT_EQ(height, 2);
  for (int i = 0; i < 6; ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(rgb[3 * i + c], ToSrgb8(image.pixels[i][c])) << i << " " << c;
  }
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"a.png"}) << "no temporary file stays";
}

TEST(PngTest, ExposureReachesTheFile) {
  const ScratchFolder folder;
  Image image(1, 1);
  image.at(0, 0) = Rgb(0.1f, 0.2f, 0.9f);
  WritePng(image, 1.0f, folder.File("a.png"));
  int width = 0, height = 0;
  const auto rgb = ReadRgb(folder.File("a.png"), &width, &height);
  EXPECT_EQ(rgb, (std::vector<unsigned char>{ToSrgb8(0.2f), ToSrgb8(0.4f), 255}));
}

TEST(PngTest, UnwritablePathIsOneSentenceAndLeavesNothing) {
  const ScratchFolder folder;
  EXPECT_THROW(WritePng(Image(2, 2), 0, folder.File("missing/a.png")), InputError);
  EXPECT_TRUE(folder.Entries().empty());
}

TEST(PngTest, TheToneCurveComesAfterExposureAndBeforeSrgb) {
  const ScratchFolder folder;
  Image image(1, 1);
  image.at(0, 0) = Rgb(0.25f, 1, 50);
  WritePng(image, 1, folder.File("a.png"), ToneCurve::kFilmic);
  int width = 0, height = 0;
  const auto rgb = ReadRgb(folder.File("a.png"), &width, &height);
  for (int c = 0; c < 2; ++c) {
    EXPECT_EQ(rgb[c], ToSrgb8(ToneMap(ToneCurve::kFilmic, 2 * image.at(0, 0)[c]))) << c;
    EXPECT_NE(rgb[c], ToSrgb8(image.at(0, 0)[c], 1)) << c;
  }
  EXPECT_EQ(rgb[2], 255);
}

TEST(PngMaskTest, MasksComeBackAndDirectoriesAreRefused) {
  const ScratchFolder folder;
  Mask mask{5, 3, std::vector<bool>(15, false)};
  mask.set[0] = mask.set[7] = mask.set[14] = true;
  WritePngMask(mask, folder.File("m.png"));
  const Mask read = ReadPngMask(folder.File("m.png"));
  EXPECT_EQ(read.width, 5);
  EXPECT_EQ(read.height, 3);
  EXPECT_EQ(read.set, mask.set);
  EXPECT_THAT(ErrorOf(folder.path()), HasSubstr("directory"));
}

TEST(PngMaskTest, ReadsEveryKindOfPng) {
  const ScratchFolder folder;
  const std::string path = folder.File("m.png");
  const std::vector<bool> expected{true, false, true, false};

  WriteRow(path, 1, PNG_COLOR_TYPE_GRAY, {0b10100000});
  EXPECT_EQ(ReadPngMask(path).set, expected) << "1-bit grey";
  WriteRow(path, 2, PNG_COLOR_TYPE_GRAY, {0b11001000});
  EXPECT_EQ(ReadPngMask(path).set, expected) << "2-bit grey: 3, 0, 2, 0 of 3";
  WriteRow(path, 8, PNG_COLOR_TYPE_GRAY, {128, 127, 255, 0});
  EXPECT_EQ(ReadPngMask(path).set, expected) << "8-bit grey, at the threshold";
  WriteRow(path, 16, PNG_COLOR_TYPE_GRAY, {0x80, 0x80, 0x7f, 0x00, 0xff, 0xff, 0x30, 0});
  EXPECT_EQ(ReadPngMask(path).set, expected) << "16-bit grey: linear would put 0x3000 above half";
  WriteRow(path, 8, PNG_COLOR_TYPE_RGB, {200, 0, 0, 0, 255, 255, 128, 0, 0, 100, 255, 0});
  EXPECT_EQ(ReadPngMask(path).set, expected) << "RGB: the first channel decides";
  WriteRow(path, 8, PNG_COLOR_TYPE_RGB_ALPHA, {200, 0, 0, 0, 0, 255, 255, 9, 128, 0, 0, 1, 100, 255, 0, 255});
  EXPECT_EQ(ReadPngMask(path).set, expected) << "alpha does not matter";
  WriteRow(path, 8, PNG_COLOR_TYPE_PALETTE, {1, 0, 1, 0}, {{0, 9, 9}, {250, 0, 0}});
  EXPECT_EQ(ReadPngMask(path).set, expected) << "palette";
}

TEST(PngMaskTest, TheTruthsMasksLeaveOutTheLamp) {
  const Mask mask = ReadPngMask(std::string(LOBE_TEST_DATA) + "/truth/cornell_diffuse.view0.mask.png");
  EXPECT_EQ(mask.width, 256);
  EXPECT_EQ(mask.height, 256);
  const auto masked = std::count(mask.set.begin(), mask.set.end(), true);
  EXPECT_GT(masked, 100);
  EXPECT_LT(masked, 256 * 256 / 4);
}

TEST(PngMaskTest, BadFilesAreNamedWithWhatIsWrong) {
  const ScratchFolder folder;
  EXPECT_THAT(ErrorOf(folder.File("none.png")), AllOf(HasSubstr("none.png"), HasSubstr("cannot be opened")));

  const std::string path = folder.File("bad.png");
  WriteWholeFile(path, "");
  EXPECT_THAT(ErrorOf(path), AllOf(HasSubstr(path), HasSubstr("signature")));
  WriteWholeFile(path, "this is not a picture at all");
  EXPECT_THAT(ErrorOf(path), HasSubstr("signature"));

  WriteRow(path, 8, PNG_COLOR_TYPE_GRAY, {1, 2, 3, 4});
  const std::string whole = ReadWholeFile(path);
  for (const size_t length : {size_t(9), size_t(20), size_t(40), whole.size() - 20}) {
    WriteWholeFile(path, whole.substr(0, length));
    EXPECT_THAT(ErrorOf(path), AllOf(HasSubstr(path), Not(HasSubstr("no error")))) << "cut to " << length;
  }
}

}  // namespace
}  // namespace lobe
