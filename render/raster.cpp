// Drawing::Rasterise: lines by distance to the pen's path, polygons by exact horizontal and sampled
// vertical coverage. Blending happens on sRGB values, as browsers do with SVG.

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "render/drawing.h"
#include "render/stroke_font.h"

namespace lobe {
namespace {

using Point = Drawing::Point;
using Path = std::vector<Point>;

class Canvas {
 public:
  Canvas(int width, int height) : width_(width), height_(height), rgb_(size_t(3) * width * height, 255.0f) {}

  void Blend(int x, int y, double r, double g, double b, double coverage) {
    float* p = &rgb_[3 * (size_t(y) * width_ + x)];
    const float a = static_cast<float>(std::min(coverage, 1.0));
    p[0] += a * (static_cast<float>(r) - p[0]);
    p[1] += a * (static_cast<float>(g) - p[1]);
    p[2] += a * (static_cast<float>(b) - p[2]);
  }

  /// The union of several paths drawn with a round pen, blended once, so that joints do not darken.
  void Stroke(const std::vector<Path>& paths, double width, const Drawing::Colour& colour);
  void Fill(const Path& polygon, const Drawing::Colour& colour);
  void Picture(const Drawing::Picture& picture, double scale);

  std::vector<unsigned char> Bytes() const {
    std::vector<unsigned char> bytes(rgb_.size());
    for (size_t i = 0; i < rgb_.size(); ++i) bytes[i] = static_cast<unsigned char>(std::lround(rgb_[i]));
    return bytes;
  }

 private:
  int ClampX(double x) const { return static_cast<int>(std::clamp(x, 0.0, double(width_))); }
  int ClampY(double y) const { return static_cast<int>(std::clamp(y, 0.0, double(height_))); }
  int width_, height_;
  std::vector<float> rgb_;
};

double DistanceToSegment(const Point& p, const Point& a, const Point& b) {
  const Point d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * d).norm();
}

void Canvas::Stroke(const std::vector<Path>& paths, double width, const Drawing::Colour& colour) {
  const double reach = 0.5 * width + 0.5;  // a pixel is covered half when its centre is on the edge
  Eigen::AlignedBox2d box;
  for (const Path& path : paths) {
    for (const Point& p : path) box.extend(p);
  }
  if (box.isEmpty()) return;
  const int x0 = ClampX(box.min().x() - reach), x1 = ClampX(box.max().x() + reach + 1);
  const int y0 = ClampY(box.min().y() - reach), y1 = ClampY(box.max().y() + reach + 1);
  if (x1 <= x0 || y1 <= y0) return;
  std::vector<float> coverage(size_t(x1 - x0) * (y1 - y0), 0.0f);
  for (const Path& path : paths) {
    for (size_t i = 0; i + 1 < path.size(); ++i) {
      const Point &a = path[i], &b = path[i + 1];
      for (int y = std::max(y0, ClampY(std::min(a.y(), b.y()) - reach));
           y < std::min(y1, ClampY(std::max(a.y(), b.y()) + reach + 1)); ++y) {
        for (int x = std::max(x0, ClampX(std::min(a.x(), b.x()) - reach));
             x < std::min(x1, ClampX(std::max(a.x(), b.x()) + reach + 1)); ++x) {
          float& c = coverage[size_t(y - y0) * (x1 - x0) + (x - x0)];
          const double inside = reach - DistanceToSegment({x + 0.5, y + 0.5}, a, b);
          c = std::max(c, static_cast<float>(std::clamp(inside, 0.0, std::min(1.0, width))));
        }
      }
    }
  }
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const float c = coverage[size_t(y - y0) * (x1 - x0) + (x - x0)];
      if (c > 0) Blend(x, y, colour.r, colour.g, colour.b, c * colour.alpha);
    }
  }
}

void Canvas::Fill(const Path& polygon, const Drawing::Colour& colour) {
  constexpr int kSamples = 4;  // sub-scanlines per row
  if (polygon.size() < 3) return;
  Eigen::AlignedBox2d box;
  for (const Point& p : polygon) box.extend(p);
  std::vector<float> row(width_);
  std::vector<std::pair<double, int>> crossings;  // x, direction
  for (int y = ClampY(box.min().y()); y < ClampY(box.max().y() + 1); ++y) {
    std::fill(row.begin(), row.end(), 0.0f);
    for (int s = 0; s < kSamples; ++s) {
      const double at = y + (s + 0.5) / kSamples;
      crossings.clear();
      for (size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if ((a.y() <= at) == (b.y() <= at)) continue;
        crossings.emplace_back(a.x() + (at - a.y()) / (b.y() - a.y()) * (b.x() - a.x()),
                               a.y() < b.y() ? 1 : -1);
      }
      std::sort(crossings.begin(), crossings.end());
      int winding = 0;
      for (size_t i = 0; i + 1 < crossings.size(); ++i) {
        winding += crossings[i].second;
        if (winding == 0) continue;
        const double from = std::clamp(crossings[i].first, 0.0, double(width_));
        const double to = std::clamp(crossings[i + 1].first, 0.0, double(width_));
        for (int x = static_cast<int>(from); x < width_ && x < to; ++x) {
          row[x] += static_cast<float>((std::min(to, x + 1.0) - std::max(from, double(x))) / kSamples);
        }
      }
    }
    for (int x = 0; x < width_; ++x) {
      if (row[x] > 0) Blend(x, y, colour.r, colour.g, colour.b, row[x] * colour.alpha);
    }
  }
}

void Canvas::Picture(const Drawing::Picture& p, double scale) {
  const Point corner = p.corner * scale;
  const double width = p.width * scale, height = p.height * scale;
  for (int y = ClampY(corner.y()); y < ClampY(std::ceil(corner.y() + height)); ++y) {
    for (int x = ClampX(corner.x()); x < ClampX(std::ceil(corner.x() + width)); ++x) {
      const double u = (x + 0.5 - corner.x()) / width, v = (y + 0.5 - corner.y()) / height;
      if (u < 0 || u >= 1 || v < 0 || v >= 1) continue;
      const unsigned char* c = &p.rgba[4 * (size_t(v * p.rows) * p.columns + size_t(u * p.columns))];
      Blend(x, y, c[0], c[1], c[2], c[3] / 255.0);
    }
  }
}

Path Scaled(const Path& path, double scale, const Point& offset = Point::Zero()) {
  Path scaled;
  for (const Point& p : path) scaled.push_back(p * scale + offset);
  return scaled;
}

/// Cuts a path into dashes by arc length.
std::vector<Path> Dashes(const Path& path, double dash) {
  std::vector<Path> dashes;
  double left = dash;
  bool on = true;
  if (!path.empty()) dashes.push_back({path[0]});
  for (size_t i = 0; i + 1 < path.size(); ++i) {
    Point at = path[i];
    double length = (path[i + 1] - at).norm();
    while (length > left) {
      at += (path[i + 1] - at) * (left / length);
      length -= left;
      left = dash;
      if (on) dashes.back().push_back(at);
      on = !on;
      if (on) dashes.push_back({at});
    }
    left -= length;
    if (on) dashes.back().push_back(path[i + 1]);
  }
  return dashes;
}

struct Painter {
  Canvas& canvas;
  double scale;

  void operator()(const Drawing::Line& line) const {
    const Path path = Scaled(line.points, scale);
    canvas.Stroke(line.dash > 0 ? Dashes(path, line.dash * scale) : std::vector<Path>{path},
                  line.width * scale, line.colour);
  }
  void operator()(const Drawing::Fill& fill) const { canvas.Fill(Scaled(fill.points, scale), fill.colour); }
  void operator()(const Drawing::Text& text) const {
    const double width = StrokeTextWidth(text.text, text.size);
    const double shift = text.anchor == Drawing::Anchor::kStart ? 0
                         : text.anchor == Drawing::Anchor::kEnd ? width
                                                                : width / 2;
    std::vector<Path> strokes;
    for (const Path& stroke : StrokeText(text.text, text.size)) {
      strokes.push_back(Scaled(stroke, scale, (text.at - Point(shift, 0)) * scale));
    }
    canvas.Stroke(strokes, 0.09 * text.size * scale, text.colour);  // weight chosen by eye
  }
  void operator()(const Drawing::Picture& picture) const { canvas.Picture(picture, scale); }
};

}  // namespace

std::vector<unsigned char> Drawing::Rasterise(int scale) const {
  Canvas canvas(width_ * scale, height_ * scale);
  for (const Shape& shape : shapes_) std::visit(Painter{canvas, double(scale)}, shape);
  return canvas.Bytes();
}

}  // namespace lobe
