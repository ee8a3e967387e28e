// WriteLobeGlb: the lobe as a surface that any glTF viewer turns about.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "brdf/frame.h"
#include "render/lobe_figures.h"
#include "render/lobe_plot.h"
#include "scene/glb_writer.h"

namespace lobe {
namespace {

using nlohmann::json;

/// A triangulated hemisphere of directions: the pole, then rings out to the horizon.
struct DirectionGrid {
  std::vector<Vec3d> directions{Vec3d(0, 0, 1)};
  std::vector<uint32_t> triangles;  ///< counter-clockwise seen from outside

  DirectionGrid(int rings, int azimuths) {
    for (int i = 1; i <= rings; ++i) {
      const double theta = std::numbers::pi / 2 * i / rings;
      for (int j = 0; j < azimuths; ++j) {
        const double phi = 2 * std::numbers::pi * j / azimuths;
        // The last ring lies on the horizon to the last bit, not a rounding error below it.
        directions.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                i == rings ? 0.0 : std::cos(theta));
      }
    }
    const auto at = [&](int ring, int j) { return uint32_t(1 + (ring - 1) * azimuths + j % azimuths); };
    for (int j = 0; j < azimuths; ++j) {
      Add(0, at(1, j), at(1, j + 1));
      for (int i = 1; i < rings; ++i) {
        Add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        Add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }

 private:
  void Add(uint32_t a, uint32_t b, uint32_t c) { triangles.insert(triangles.end(), {a, b, c}); }
};

void Append(std::vector<float>* list, const Eigen::Array3d& v) {
  for (int c = 0; c < 3; ++c) list->push_back(static_cast<float>(v[c]));
}

/// Primitive of the lobe's surface: COLOR_0 linear, radiance over the peak's brightest channel.
json LobePrimitive(const Eigen::MatrixXd& coefficients, float size, GlbWriter* glb) {
  const LobeReader lobe(coefficients);
  // Six rings for an oscillation of the highest degree (chosen); 64 for a smooth silhouette.
  const int rings = std::max(64, 6 * lobe.l_max());
  const DirectionGrid grid(rings, 2 * rings);

  // Scaled by the grid's own greatest magnitude, so that nothing reaches beyond `size`.
  std::vector<Eigen::Array3d> radiance;
  std::vector<double> luminance;
  double longest = 0, brightest = 0;
  for (const Vec3d& w : grid.directions) {
    radiance.push_back(lobe.Radiance(w));
    luminance.push_back(lobe.Luminance(w));
    longest = std::max(longest, std::abs(luminance.back()));
    brightest = std::max(brightest, radiance.back().maxCoeff());
  }
  std::vector<float> positions, colours;
  for (size_t i = 0; i < grid.directions.size(); ++i) {
    const double length = longest > 0 ? std::abs(luminance[i]) / longest : 0;
    Append(&positions, (grid.directions[i] * length * size).array());
    const bool negative = luminance[i] < 0;
    Append(&colours, negative        ? Eigen::Array3d(0.02, 0.12, 1.0)
                     : brightest > 0 ? Eigen::Array3d((radiance[i] / brightest).max(0.0).min(1.0))
                                     : Eigen::Array3d(Eigen::Array3d::Zero()));
  }
  return {{"attributes",
           {{"POSITION", glb->AddFloats(positions, "VEC3", GlbWriter::Target::kVertices, true)},
            {"COLOR_0", glb->AddFloats(colours, "VEC3", GlbWriter::Target::kVertices)}}},
          {"indices", glb->AddUints(grid.triangles, GlbWriter::Target::kIndices)},
          {"material", 0}};
}

/// The frame's axes as lines: x red, y green, z blue.
json AxesPrimitive(float length, GlbWriter* glb) {
  std::vector<float> positions, colours;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Array3d tip = Eigen::Array3d::Zero(), colour = Eigen::Array3d::Constant(0.05);
    tip[axis] = length;
    colour[axis] = 0.9;
    Append(&positions, Eigen::Array3d::Zero());
    Append(&positions, tip);
    Append(&colours, colour);
    Append(&colours, colour);
  }
  return {{"attributes",
           {{"POSITION", glb->AddFloats(positions, "VEC3", GlbWriter::Target::kVertices, true)},
            {"COLOR_0", glb->AddFloats(colours, "VEC3", GlbWriter::Target::kVertices)}}},
          {"mode", 1},
          {"material", 0}};
}

}  // namespace

void WriteLobeGlb(const Eigen::MatrixXd& coefficients, const Eigen::Vector3f& origin,
                  const Eigen::Vector3f& normal, float size, const std::string& path) {
  const Frame frame(normal);
  Eigen::Matrix3f axes;
  axes << frame.x, frame.y, frame.z;
  const Eigen::Quaternionf rotation = Eigen::Quaternionf(axes).normalized();

  GlbWriter glb;
  json& document = glb.document;
  const json lobe = LobePrimitive(coefficients, size, &glb);
  const json frame_axes = AxesPrimitive(1.15f * size, &glb);
  document["meshes"] = {{{"name", "lobe"}, {"primitives", json::array({lobe})}},
                        {{"name", "frame"}, {"primitives", json::array({frame_axes})}}};
  document["materials"] = json::array({{{"name", "radiance"},
                                        {"doubleSided", true},
                                        {"extensions", {{"KHR_materials_unlit", json::object()}}}}});
  document["extensionsUsed"] = json::array({"KHR_materials_unlit"});
  document["nodes"] = {{{"name", "node"},
                        {"translation", {origin.x(), origin.y(), origin.z()}},
                        {"rotation", {rotation.x(), rotation.y(), rotation.z(), rotation.w()}},
                        {"children", {1, 2}}},
                       {{"name", "lobe"}, {"mesh", 0}},
                       {{"name", "frame"}, {"mesh", 1}}};
  document["scenes"] = json::array({{{"name", "lobe"}, {"nodes", json::array({0})}}});
  document["scene"] = 0;
  glb.Write(path);
}

}  // namespace lobe
