#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace lobe::test {

/// Small scenes made in code. Every Add... of geometry is a surface of its own and returns its index;
/// corners given counter-clockwise seen from the front.
///
///     SceneBuilder b;
///     const uint32_t white = b.AddMaterial("white", Lambert{Rgb::Constant(0.7f)});
///     b.AddBox({0, 0, 0}, {1, 1, 1}, white, /*inward=*/true);
///     b.AddCamera("view0", {0.5f, 0.5f, 0.9f}, {0.5f, 0.5f, 0});
///     const Scene s = b.Build();
class SceneBuilder {
 public:
  uint32_t AddMaterial(Material material) {
    scene_.materials.push_back(std::move(material));
    return static_cast<uint32_t>(scene_.materials.size() - 1);
  }
  uint32_t AddMaterial(const std::string& name, const Reflectance& reflectance,
                       const Rgb& emission = Rgb::Zero(), bool double_sided = false) {
    Material m;
    m.name = name;
    m.reflectance = reflectance;
    m.emission = emission;
    m.double_sided = double_sided;
    return AddMaterial(std::move(m));
  }
  uint32_t AddLambert(const Rgb& albedo) { return AddMaterial("lambert", Lambert{albedo}); }
  /// A black lamp.
  uint32_t AddEmitter(const Rgb& radiance) { return AddMaterial("lamp", Lambert{Rgb::Zero()}, radiance); }

  uint32_t AddTriangle(const Vec3& p0, const Vec3& p1, const Vec3& p2, uint32_t material) {
    const uint32_t surface = NewSurface("triangle");
    FlatFace({p0, p1, p2}, material, surface);
    return surface;
  }

  /// Flat, convex; cut along p0-p2, with four shared vertices.
  uint32_t AddQuad(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3, uint32_t material) {
    const uint32_t surface = NewSurface("quad");
    FlatFace({p0, p1, p2, p3}, material, surface);
    return surface;
  }

  /// One surface of six flat sides that share no vertices. `inward`: a room, seen from inside.
  uint32_t AddBox(const Vec3& min, const Vec3& max, uint32_t material, bool inward = false) {
    const uint32_t surface = NewSurface("box");
    for (int axis = 0; axis < 3; ++axis) {
      for (int high = 0; high < 2; ++high) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        std::vector<Vec3> p(4, min);
        for (Vec3& q : p) q[axis] = high ? max[axis] : min[axis];
        p[1][a] = p[2][a] = max[a];  // counter-clockwise seen from +axis
        p[2][b] = p[3][b] = max[b];
        if ((high == 1) == inward) std::swap(p[1], p[3]);
        FlatFace(p, material, surface);
      }
    }
    return surface;
  }

  /// A sphere of 2 * segments * (segments - 1) triangles with smooth normals. `inward`: seen from inside.
  uint32_t AddSphere(const Vec3& centre, float radius, uint32_t material, int segments = 16,
                     bool inward = false) {
    const uint32_t surface = NewSurface("sphere");
    const uint32_t first = static_cast<uint32_t>(scene_.positions.size());
    const int columns = 2 * segments;
    const auto add = [&](double theta, double phi) {
      const Vec3 n(static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta)),
                   static_cast<float>(std::sin(theta) * std::cos(phi)));
      return AddVertex(centre + radius * n, inward ? Vec3(-n) : n);
    };
    add(0, 0);
    for (int i = 1; i < segments; ++i) {
      for (int j = 0; j < columns; ++j) add(M_PI * i / segments, 2 * M_PI * j / columns);
    }
    const uint32_t south = add(M_PI, 0);
    const auto at = [&](int i, int j) {
      if (i == 0) return first;
      if (i == segments) return south;
      return first + 1 + static_cast<uint32_t>((i - 1) * columns + j % columns);
    };
    const auto face = [&](uint32_t a, uint32_t b, uint32_t c) {
      if (inward) std::swap(b, c);
      scene_.faces.push_back({{a, b, c}, material, surface});
    };
    for (int i = 0; i < segments; ++i) {
      for (int j = 0; j < columns; ++j) {
        if (i + 1 < segments) face(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        if (i > 0) face(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
    return surface;
  }

  /// Shared vertices with normals of their own; `triangles` index `positions`.
  uint32_t AddMesh(const std::vector<Vec3>& positions, const std::vector<Vec3>& normals,
                   const std::vector<std::array<uint32_t, 3>>& triangles, uint32_t material) {
    const uint32_t surface = NewSurface("mesh");
    const uint32_t first = static_cast<uint32_t>(scene_.positions.size());
    for (size_t i = 0; i < positions.size(); ++i) AddVertex(positions[i], normals[i]);
    for (const auto& t : triangles) {
      scene_.faces.push_back({{first + t[0], first + t[1], first + t[2]}, material, surface});
    }
    return surface;
  }

  void AddCamera(const std::string& name, const Vec3& eye, const Vec3& target, const Vec3& up = Vec3::UnitY(),
                 float fov_y = 0.7f) {
    scene_.cameras.push_back(LookAt(eye, target, up, fov_y));
    scene_.cameras.back().name = name;
  }

  const Material& material(uint32_t index) const { return scene_.materials[index]; }
  Scene Build() const { return scene_; }

 private:
  uint32_t NewSurface(const std::string& kind) {
    const uint32_t surface = static_cast<uint32_t>(scene_.surface_names.size());
    scene_.surface_names.push_back(kind + " " + std::to_string(surface));
    if (scene_.path.empty()) scene_.path = "test scene";
    return surface;
  }

  uint32_t AddVertex(const Vec3& position, const Vec3& normal) {
    scene_.positions.push_back(position);
    scene_.normals.push_back(normal);
    return static_cast<uint32_t>(scene_.positions.size() - 1);
  }

  /// A convex polygon as a fan.
  void FlatFace(const std::vector<Vec3>& p, uint32_t material, uint32_t surface) {
    const Vec3 n = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    const uint32_t first = static_cast<uint32_t>(scene_.positions.size());
    for (const Vec3& q : p) AddVertex(q, n);
    for (uint32_t i = 2; i < p.size(); ++i) {
      scene_.faces.push_back({{first, first + i - 1, first + i}, material, surface});
    }
  }

  Scene scene_;
};

}  // namespace lobe::test
