#include "bench/log_log_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <utility>

namespace lobe {
namespace {

using Point = Drawing::Point;
using Anchor = Drawing::Anchor;

constexpr double kPanelWidth = 380, kPanelHeight = 270;
constexpr double kLeft = 74, kAbove = 78, kBetween = 84, kLegend = 216;
constexpr Drawing::Colour kInk{34, 34, 40}, kFaint{96, 96, 108}, kGrid{226, 227, 232}, kDecade{186, 188, 198};

// Range of one axis, in powers of ten.
struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void Take(double value) {
    if (!(value > 0)) return;
    low = std::min(low, std::log10(value));
    high = std::max(high, std::log10(value));
  }
  // A little room on either side, and half a decade at least.
  void Close() {
    if (low > high) low = 0, high = 1;
    const double room = std::max(0.06 * (high - low), 0.5 * (0.5 - (high - low)));
    low -= room;
    high += room;
  }
  double At(double value) const { return (std::log10(value) - low) / (high - low); }  // 0..1
};

struct Tick {
  double value;
  bool decade;
};

// Powers of ten, and where there are few of them 2 and 5 times those.
std::vector<Tick> Ticks(const Axis& axis) {
  std::vector<Tick> ticks;
  for (int e = int(std::floor(axis.low)); e <= int(std::ceil(axis.high)); ++e) {
    for (const int step : {1, 2, 5}) {
      const double value = step * std::pow(10.0, e), at = axis.At(value);
      if (at >= 0 && at <= 1) ticks.push_back({value, step == 1});
    }
  }
  return ticks;
}

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

// Twelve corners are round enough at this size, and files stay small.
void DrawMark(Drawing* drawing, const Point& centre, double radius, const Drawing::Colour& colour) {
  constexpr int kCorners = 12;
  Drawing::Fill disc;
  disc.colour = colour;
  for (int i = 0; i < kCorners; ++i) {
    const double t = 2 * std::numbers::pi * i / kCorners;
    disc.points.push_back(centre + radius * Point(std::cos(t), std::sin(t)));
  }
  drawing->Add(std::move(disc));
}

void DrawGrid(Drawing* drawing, const LogLogPanel& panel, const Point& corner, const Axis& x, const Axis& y) {
  const double bottom = corner.y() + kPanelHeight, right = corner.x() + kPanelWidth;
  for (const Tick& t : Ticks(x)) {
    const double at = corner.x() + kPanelWidth * x.At(t.value);
    drawing->Add(Drawing::Line{{{at, corner.y()}, {at, bottom}}, t.decade ? kDecade : kGrid, 1});
    drawing->Add(Drawing::Text{{at, bottom + 16}, Number(t.value), 11, kFaint, Anchor::kMiddle});
  }
  for (const Tick& t : Ticks(y)) {
    const double at = bottom - kPanelHeight * y.At(t.value);
    drawing->Add(Drawing::Line{{{corner.x(), at}, {right, at}}, t.decade ? kDecade : kGrid, 1});
    drawing->Add(Drawing::Text{{corner.x() - 7, at + 4}, Number(t.value), 11, kFaint, Anchor::kEnd});
  }
  drawing->Add(
      Drawing::Line{{corner, {right, corner.y()}, {right, bottom}, {corner.x(), bottom}, corner}, kFaint, 1});
  drawing->Add(Drawing::Text{{corner.x(), corner.y() - 10}, panel.title, 13, kInk});
  drawing->Add(
      Drawing::Text{{corner.x() + kPanelWidth / 2, bottom + 36}, panel.x_label, 12, kInk, Anchor::kMiddle});
  // Drawings have no turned text: the label stands above the axis.
  drawing->Add(Drawing::Text{{right, corner.y() - 10}, panel.y_label, 12, kInk, Anchor::kEnd});
}

void DrawSeries(Drawing* drawing, const PlotSeries& s, const Point& corner, const Axis& x, const Axis& y) {
  std::vector<Point> line;
  for (const Point& p : s.points) {
    if (!(p.x() > 0 && p.y() > 0)) continue;
    line.push_back(corner + Point(kPanelWidth * x.At(p.x()), kPanelHeight * (1 - y.At(p.y()))));
  }
  if (s.joined && line.size() > 1) drawing->Add(Drawing::Line{line, s.colour, 1.8, s.dash});
  for (const Point& p : line) DrawMark(drawing, p, s.joined ? 3.4 : 2.4, s.colour);
}

void DrawLegend(Drawing* drawing, const std::vector<PlotSeries>& series, const Point& corner) {
  Point at = corner;
  for (const PlotSeries& s : series) {
    if (s.name.empty()) continue;
    if (s.joined) drawing->Add(Drawing::Line{{at, at + Point(30, 0)}, s.colour, 1.8, s.dash});
    DrawMark(drawing, at + Point(15, 0), s.joined ? 3.4 : 2.4, s.colour);
    drawing->Add(Drawing::Text{at + Point(38, 4), s.name, 12, kInk});
    at.y() += 21;
  }
}

}  // namespace

Drawing DrawLogLogPanels(const std::string& title, const std::vector<LogLogPanel>& panels, int columns) {
  const int rows = (int(panels.size()) + columns - 1) / columns;
  std::vector<Axis> x(columns), y(rows);
  for (size_t i = 0; i < panels.size(); ++i) {
    for (const PlotSeries& s : panels[i].series) {
      for (const Point& p : s.points) {
        if (!(p.x() > 0 && p.y() > 0)) continue;
        x[i % columns].Take(p.x());
        y[i / columns].Take(p.y());
      }
    }
  }
  for (Axis& axis : x) axis.Close();
  for (Axis& axis : y) axis.Close();

  const double panels_right = kLeft + columns * (kPanelWidth + kLeft) - kLeft;
  Drawing drawing(int(panels_right + 24 + kLegend), int(kAbove + rows * (kPanelHeight + kBetween) - 24));
  drawing.Add(Drawing::Text{{kLeft, 34}, title, 17, kInk});
  for (size_t i = 0; i < panels.size(); ++i) {
    const int column = int(i) % columns, row = int(i) / columns;
    const Point corner(kLeft + column * (kPanelWidth + kLeft), kAbove + row * (kPanelHeight + kBetween));
    DrawGrid(&drawing, panels[i], corner, x[column], y[row]);
    for (const PlotSeries& s : panels[i].series) DrawSeries(&drawing, s, corner, x[column], y[row]);
  }
  DrawLegend(&drawing, panels.front().series, {panels_right + 24, kAbove + 8});
  return drawing;
}

}  // namespace lobe
