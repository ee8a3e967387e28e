#include "render/exr.h"

#include <cstring>
#include <limits>

#include <ImathBox.h>
#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

Image Ramp(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.at(x, y) = Rgb(float(x), float(y), 0.25f * float(x) - float(y));
  }
  return image;
}

void ExpectEqual(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    ASSERT_TRUE((a.pixels[i] == b.pixels[i]).all()) << "pixel " << i << ": " << a.pixels[i].transpose();
  }
}

std::string ErrorOf(const std::string& path) {
  try {
    ReadExr(path);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(ExrTest, RoundTripIsExact) {
  const ScratchFolder folder;
  Image image = Ramp(37, 19);
  image.at(3, 4) = Rgb(1e-30f, std::numeric_limits<float>::infinity(), -123.456f);
  WriteExr(image, {}, folder.File("a.exr"));
  ExpectEqual(ReadExr(folder.File("a.exr")), image);
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"a.exr"}) << "no temporary file stays";
}

TEST(ExrTest, AttributesComeBackWithTheirTypes) {
  const ScratchFolder folder;
  std::vector<float> matrix(16);
  for (int i = 0; i < 16; ++i) matrix[i] = 0.5f * float(i);
  const ExrAttributes written{{"lobeMode", std::string("stored")},
                              {"samplesPerPixel", 16},
                              {"renderSeconds", 1.5f},
                              {"worldToCamera", matrix},
                              {"threeNumbers", std::vector<float>{1, 2, 3}}};
  WriteExr(Ramp(4, 4), written, folder.File("a.exr"));
  const ExrAttributes read = ReadExrAttributes(folder.File("a.exr"));
  for (const auto& [name, value] : written) {
    ASSERT_TRUE(read.count(name)) << name;
    EXPECT_EQ(read.at(name), value) << name;
  }
}

/// Writes channels of one type by OpenEXR itself, data window from (-3, 5), more channels than asked for.
void WriteOddFile(const std::string& path, const Image& image, Imf::PixelType type, bool tiles) {
  const Imath::Box2i window({-3, 5}, {image.width - 4, image.height + 4});
  Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
  Imf::FrameBuffer frame;
  const size_t count = image.pixels.size();
  std::vector<std::vector<char>> planes;
  const char* names[] = {"R", "G", "B", "A", "albedo.R"};
  for (int c = 0; c < 5; ++c) {
    const size_t size = type == Imf::HALF ? 2 : 4;
    planes.emplace_back(count * size);
    for (size_t i = 0; i < count; ++i) {
      const float value = c < 3 ? image.pixels[i][c] : 77.0f;
      if (type == Imf::HALF) {
        const half h(value);
        std::memcpy(&planes.back()[i * size], &h, 2);
      } else if (type == Imf::UINT) {
        const uint32_t u = static_cast<uint32_t>(value);
        std::memcpy(&planes.back()[i * size], &u, 4);
      } else {
        std::memcpy(&planes.back()[i * size], &value, 4);
      }
    }
    header.channels().insert(names[c], Imf::Channel(type));
    frame.insert(names[c], Imf::Slice::Make(type, planes.back().data(), window, size, size * image.width));
  }
  if (tiles) {
    header.setTileDescription(Imf::TileDescription(16, 8));
    Imf::TiledOutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  } else {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  }
}

TEST(ExrTest, ReadsEveryPixelTypeScanLinesAndTilesAtAnyOffset) {
  const ScratchFolder folder;
  Image image = Ramp(35, 21);
  for (Rgb& p : image.pixels) p = p.abs().round();  // representable as half and as unsigned integer
  for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT}) {
    for (const bool tiles : {false, true}) {
      SCOPED_TRACE(testing::Message() << "type " << type << " tiles " << tiles);
      WriteOddFile(folder.File("odd.exr"), image, type, tiles);
      ExpectEqual(ReadExr(folder.File("odd.exr")), image);
    }
  }
}

TEST(ExrTest, ReadsTheTruth) {
  const Image image = ReadExr(std::string(LOBE_TEST_DATA) + "/truth/cornell_diffuse.view0.a.exr");
  EXPECT_EQ(image.width, 256);
  EXPECT_EQ(image.height, 256);
  // The red wall is on the left of the Cornell box and the green one on the right.
  EXPECT_GT(image.at(20, 128)[0], 2 * image.at(20, 128)[1]);
  EXPECT_GT(image.at(235, 128)[1], image.at(235, 128)[0]);
}

TEST(ExrTest, MissingChannelNamesThoseThereAre) {
  const ScratchFolder folder;
  const std::string path = folder.File("grey.exr");
  {
    Imf::Header header(2, 2);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    float zeros[4] = {};
    Imf::FrameBuffer frame;
    for (const char* name : {"Y", "R"}) {
      frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(zeros), 4, 8));
    }
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(2);
  }
  EXPECT_THAT(ErrorOf(path), AllOf(HasSubstr(path), HasSubstr("no channel G"), HasSubstr("R, Y")));
}

TEST(ExrTest, BadFilesGiveOneSentence) {
  const ScratchFolder folder;
  EXPECT_THAT(ErrorOf(folder.File("none.exr")), AllOf(HasSubstr("none.exr"), HasSubstr("no such file")));
  EXPECT_THAT(ErrorOf(folder.path()), HasSubstr("directory"));
  const std::string path = folder.File("bad.exr");
  WriteWholeFile(path, "");
  EXPECT_THAT(ErrorOf(path), HasSubstr("magic"));
  WriteWholeFile(path, "glTF rubbish that goes on for a while");
  EXPECT_THAT(ErrorOf(path), HasSubstr("magic"));
}

TEST(ExrTest, FilesCutAnywhereAreRefused) {
  const ScratchFolder folder;
  const std::string path = folder.File("cut.exr");
  WriteExr(Ramp(40, 40), {{"lobeMode", std::string("stored")}}, path);
  const std::string whole = ReadWholeFile(path);
  for (size_t length = 4; length < whole.size(); length += whole.size() / 23 + 1) {
    WriteWholeFile(path, whole.substr(0, length));
    const std::string error = ErrorOf(path);
    EXPECT_THAT(error, AllOf(HasSubstr(path), HasSubstr("not a readable OpenEXR"), Not(HasSubstr("\n"))))
        << "cut to " << length << " of " << whole.size();
  }
}

TEST(ExrTest, AbsurdDataWindowIsRefusedBeforeMemoryIsAsked) {
  const ScratchFolder folder;
  const std::string path = folder.File("huge.exr");
  WriteExr(Ramp(8, 8), {}, path);
  std::string bytes = ReadWholeFile(path);
  const std::string key = std::string("dataWindow") + '\0' + "box2i" + '\0';
  const size_t at = bytes.find(key);
  ASSERT_NE(at, std::string::npos);
  const int32_t window[4] = {0, 0, 999999, 999999};
  std::memcpy(&bytes[at + key.size() + 4], window, sizeof window);
  WriteWholeFile(path, bytes);
  EXPECT_THAT(ErrorOf(path), AllOf(HasSubstr(path), Not(HasSubstr("no error"))));
}

}  // namespace
}  // namespace lobe
