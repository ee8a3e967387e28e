#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/drawing.h"

namespace lobe {

/// Range of one axis of a plot.
struct PlotAxis {
  double low = 0, high = 1;
  bool logarithmic = false;  ///< then low > 0
  std::vector<double> ticks;
  std::string (*format)(double) = nullptr;  ///< of ticks; null: three digits

  /// Where `value` lies, 0 at low and 1 at high; beyond is allowed.
  double Place(double value) const;
  /// From 0 (or a little below `least`, if that is negative) to the next round number above `most`.
  static PlotAxis Linear(double least, double most);
  /// Decades that hold both; at least one.
  static PlotAxis Decades(double least, double most);
};

/// A rectangle with a frame, ticks and curves, in a Drawing. What lies outside is cut off at the frame.
class PlotPanel {
 public:
  /// (left, top, width, height) is the frame; title and ticks stand around it. Draws both at once.
  PlotPanel(Drawing* drawing, double left, double top, double width, double height, const std::string& title,
            PlotAxis x, PlotAxis y);

  using Points = std::vector<Drawing::Point>;  ///< in the axes' units
  void Line(const Points& points, Drawing::Colour colour, double width = 1.8, double dash = 0);
  /// The area between the curve and y = 0.
  void Area(const Points& points, Drawing::Colour colour);
  void Dots(const Points& points, Drawing::Colour colour, double radius = 2.6);
  void VerticalMark(double x, Drawing::Colour colour, const std::string& label);

  /// Colours of frames, and of words beside them.
  static constexpr Drawing::Colour kInk{34, 34, 40}, kFaint{110, 110, 122}, kGrid{226, 227, 233};

 private:
  Drawing::Point At(const Drawing::Point& p) const;
  /// Stretches of a curve that lie in the frame, cut at its edges.
  std::vector<Points> Inside(const Points& points) const;

  Drawing* drawing_;
  double left_, top_, width_, height_;
  PlotAxis x_, y_;
};

}  // namespace lobe
