#pragma once

#include <string>
#include <vector>

#include "render/drawing.h"

namespace lobe {

/// One curve of a plot: points joined in their order, each marked. `dash` as of Drawing::Line.
struct PlotSeries {
  std::string name;  ///< in the legend; empty: not there
  Drawing::Colour colour;
  double dash = 0;
  bool joined = true;  ///< false: marks alone, smaller
  std::vector<Drawing::Point> points;
};

/// Axes of one plot, and what is in it. Points that are not positive are left out: logarithms of them are
/// not.
struct LogLogPanel {
  std::string title, x_label, y_label;
  std::vector<PlotSeries> series;
};

/// Panels side by side and below each other, `columns` in a row, with a legend of the first one's series on
/// the right. Panels of one column share their x axis' range, panels of one row their y axis', so that they
/// can be compared at sight.
Drawing DrawLogLogPanels(const std::string& title, const std::vector<LogLogPanel>& panels, int columns);

}  // namespace lobe
