#include "render/lobe_plot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "brdf/frame.h"
#include "scene/gltf_file.h"
#include "scene/input_error.h"
#include "sh/zernike.h"
#include "tests/support/scratch_folder.h"

namespace lobe {
namespace {

using test::ReadWholeFile;
using test::ScratchFolder;
using ::testing::HasSubstr;
using ::testing::Not;

/// 1 + 2 x: greatest towards +x on the horizon (3), negative beyond x = -1/2 (down to -1).
Eigen::MatrixXd TiltedLobe() {
  const Eigen::VectorXd lobe = ProjectCosineWeighted([](const Vec3d& w) { return 1 + 2 * w.x(); }, 6, 6);
  return lobe * Eigen::RowVector3d(1, 1, 1);
}

TEST(LobePlotTest, SvgSaysTheFigures) {
  const std::string svg = LobeSvg(TiltedLobe(), "node 7");
  EXPECT_THAT(svg, HasSubstr(">node 7<"));
  EXPECT_THAT(svg, HasSubstr("flux R 3.14, G 3.14, B 3.14"));
  EXPECT_THAT(svg, HasSubstr("peak 3 W/(m² sr) at θ 90.0°, φ 0.0°"));
  EXPECT_THAT(svg, HasSubstr("negative part 10.0"));  // 1/8 of 5/4: LobeFiguresTest
  EXPECT_THAT(svg, HasSubstr("degree 6"));
  EXPECT_THAT(svg, HasSubstr("φ 270°"));
}

// 1 + 2 (w . a) with a at azimuth 200 degrees: slices at 200 / 20 and 290 / 110.
TEST(LobePlotTest, SlicesGoThroughThePeak) {
  const double phi = 200 * std::numbers::pi / 180;
  const Eigen::VectorXd lobe = ProjectCosineWeighted(
      [&](const Vec3d& w) { return 1 + 2 * (w.x() * std::cos(phi) + w.y() * std::sin(phi)); }, 6, 6);
  const std::string svg = LobeSvg(lobe * Eigen::RowVector3d(1, 1, 1), "");
  for (const char* label : {"φ 200°", "φ 20°", "φ 290°", "φ 110°"}) EXPECT_THAT(svg, HasSubstr(label));
}

TEST(LobePlotTest, NegativePartsAreDashed) {
  EXPECT_THAT(LobeSvg(TiltedLobe(), ""), HasSubstr("stroke-dasharray"));
  Eigen::MatrixXd positive = Eigen::MatrixXd::Zero(1, 3);
  positive.setOnes();
  EXPECT_THAT(LobeSvg(positive, ""), Not(HasSubstr("stroke-dasharray")));
}

TEST(LobePlotTest, SamePictureEveryTime) {
  EXPECT_EQ(LobeSvg(TiltedLobe(), "a"), LobeSvg(TiltedLobe(), "a"));
}

TEST(LobePlotTest, BlackLobeIsDrawnToo) {
  const std::string svg = LobeSvg(Eigen::MatrixXd::Zero(6, 3), "black");
  for (const char* broken : {"\"nan", ",nan", " nan", "\"inf", ",inf", " inf"}) {
    EXPECT_EQ(svg.find(broken), std::string::npos) << broken;
  }
}

TEST(LobePlotTest, PngIsTwiceTheSvgsSize) {
  const ScratchFolder folder;
  WriteLobePng(TiltedLobe(), "node 7", folder.File("lobe.png"));
  const std::string png = ReadWholeFile(folder.File("lobe.png"));
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  const auto big_endian = [&](size_t at) {
    return (uint8_t(png[at]) << 24) | (uint8_t(png[at + 1]) << 16) | (uint8_t(png[at + 2]) << 8) |
           uint8_t(png[at + 3]);
  };
  EXPECT_EQ(big_endian(16), 2000);  // IHDR
  EXPECT_EQ(big_endian(20), 800);
  EXPECT_EQ(folder.Entries().size(), 1u);
}

TEST(LobeSurfaceTest, DistanceIsLuminanceInTheNodesFrame) {
  const ScratchFolder folder;
  const std::string path = folder.File("lobe.glb");
  const Vec3 origin(1, 2, 3), normal = Vec3(0.48f, -0.6f, 0.64f);
  const float size = 0.25f;
  WriteLobeGlb(TiltedLobe(), origin, normal, size, path);

  const GltfFile file(path);
  const auto& document = file.json();
  const auto& root = document.at("nodes").at(document.at("scenes").at(0).at("nodes").at(0).get<int>());
  EXPECT_EQ(root.at("name"), "node");
  const auto t = root.at("translation").get<std::vector<float>>(),
             q = root.at("rotation").get<std::vector<float>>();
  EXPECT_EQ(Vec3(t[0], t[1], t[2]), origin);
  const Eigen::Matrix3f rotation = Eigen::Quaternionf(q[3], q[0], q[1], q[2]).toRotationMatrix();
  const Frame frame(normal);
  EXPECT_LT((rotation.col(0) - frame.x).norm() + (rotation.col(1) - frame.y).norm() +
                (rotation.col(2) - frame.z).norm(),
            1e-5f);

  const auto& primitive = document.at("meshes").at(0).at("primitives").at(0);
  const auto positions = file.ReadFloats(primitive.at("attributes").at("POSITION"), 3, "positions");
  const auto colours = file.ReadFloats(primitive.at("attributes").at("COLOR_0"), 3, "colours");
  ASSERT_EQ(positions.size(), colours.size());
  float longest = 0;
  for (size_t i = 0; i < positions.size(); i += 3) {
    const Vec3 p(positions[i], positions[i + 1], positions[i + 2]);
    const float r = p.norm();
    longest = std::max(longest, r);
    EXPECT_GE(p.z(), 0);
    if (r < 1e-3f) continue;
    // Whatever its direction, a vertex lies at |1 + 2 x| of the peak, 3; the sign is in the colour.
    const float expected = 1 + 2 * p.x() / r;
    EXPECT_NEAR(r, std::abs(expected) / 3 * size, 1e-5f);
    const bool blue = colours[i + 2] > 2 * colours[i];
    EXPECT_EQ(blue, expected < 0) << p.transpose();
  }
  EXPECT_NEAR(longest, size, 1e-6f);
}

TEST(LobeSurfaceTest, TrianglesFaceOutwards) {
  const ScratchFolder folder;
  const std::string path = folder.File("lobe.glb");
  Eigen::MatrixXd constant = Eigen::MatrixXd::Ones(1, 3);
  WriteLobeGlb(constant, Vec3::Zero(), Vec3::UnitY(), 1, path);
  const GltfFile file(path);
  const auto& primitive = file.json().at("meshes").at(0).at("primitives").at(0);
  const auto p = file.ReadFloats(primitive.at("attributes").at("POSITION"), 3, "positions");
  const auto indices = file.ReadIndices(primitive.at("indices"), "indices");
  float area = 0;
  for (size_t i = 0; i < indices.size(); i += 3) {
    const auto at = [&](size_t k) {
      return Vec3(p[3 * indices[k]], p[3 * indices[k] + 1], p[3 * indices[k] + 2]);
    };
    const Vec3 cross = (at(i + 1) - at(i)).cross(at(i + 2) - at(i));
    EXPECT_GT(cross.dot(at(i) + at(i + 1) + at(i + 2)), 0);
    area += 0.5f * cross.norm();
  }
  // Half a unit sphere; 64 rings are 4e-4 short of it.
  EXPECT_NEAR(area, 2 * std::numbers::pi_v<float>, 5e-3f);
}

TEST(LobeSurfaceTest, UnwritablePathLeavesNothing) {
  const ScratchFolder folder;
  EXPECT_THROW(WriteLobeGlb(TiltedLobe(), Vec3::Zero(), Vec3::UnitZ(), 1, folder.File("no/lobe.glb")),
               InputError);
  EXPECT_TRUE(folder.Entries().empty());
}

}  // namespace
}  // namespace lobe
