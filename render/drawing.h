#pragma once

#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace lobe {

/// A small vector picture: shapes in order, later ones on top. Described once, shown as SVG text or as
/// pixels. Coordinates in SVG user units, y down; colours sRGB.
class Drawing {
 public:
  using Point = Eigen::Vector2d;
  struct Colour {
    unsigned char r = 0, g = 0, b = 0;
    double alpha = 1;
  };
  enum class Anchor { kStart, kMiddle, kEnd };

  /// A polyline with round ends; `dash` > 0: dashes of that length and equal gaps.
  struct Line {
    std::vector<Point> points;
    Colour colour;
    double width = 1, dash = 0;
  };
  /// A polygon, non-zero winding.
  struct Fill {
    std::vector<Point> points;
    Colour colour;
  };
  /// UTF-8; `size` is that of the font, `at` its baseline. What the raster font lacks shows as a box.
  struct Text {
    Point at;
    std::string text;
    double size = 12;
    Colour colour;
    Anchor anchor = Anchor::kStart;
  };
  /// Pixels (8-bit RGBA, not premultiplied) stretched over a rectangle.
  struct Picture {
    Point corner;
    double width = 0, height = 0;
    int columns = 0, rows = 0;
    std::vector<unsigned char> rgba;
  };
  using Shape = std::variant<Line, Fill, Text, Picture>;

  Drawing(int width, int height) : width_(width), height_(height) {}
  void Add(Shape shape) { shapes_.push_back(std::move(shape)); }

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<Shape>& shapes() const { return shapes_; }

  /// A complete SVG document on white.
  std::string Svg() const;
  /// RGB bytes on white, row by row, width * scale by height * scale of them, anti-aliased (raster.cpp).
  std::vector<unsigned char> Rasterise(int scale) const;

 private:
  int width_, height_;
  std::vector<Shape> shapes_;
};

/// Points of an arc about `centre` from angle a to b (radians, from +x towards -y, that is upwards).
std::vector<Drawing::Point> Arc(const Drawing::Point& centre, double radius, double a, double b);

}  // namespace lobe
