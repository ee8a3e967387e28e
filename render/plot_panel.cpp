#include "render/plot_panel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace lobe {
namespace {

using Point = Drawing::Point;
using Anchor = Drawing::Anchor;

std::string Short(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

/// 1, 2 or 5 times a power of ten: the least that gives at most `most` steps.
double RoundStep(double range, int most) {
  const double power = std::pow(10, std::floor(std::log10(range / most)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (range <= factor * power * most * (1 + 1e-9)) return factor * power;
  }
  return 10 * power;
}

}  // namespace

double PlotAxis::Place(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  return std::log(std::max(value, 1e-300) / low) / std::log(high / low);
}

PlotAxis PlotAxis::Linear(double least, double most) {
  PlotAxis axis;
  if (!(most > 0) && !(least < 0)) most = 1;
  const double range = most - std::min(least, 0.0);
  const double step = RoundStep(range, 5);
  axis.low = least < 0 ? least - 0.02 * range : 0;
  axis.high = std::max(std::ceil(most / step - 1e-9), 1.0) * step;
  for (int i = int(std::ceil(axis.low / step)); i * step <= axis.high + 0.5 * step; ++i) {
    axis.ticks.push_back(i * step);
  }
  return axis;
}

PlotAxis PlotAxis::Decades(double least, double most) {
  PlotAxis axis;
  axis.logarithmic = true;
  const int from = int(std::floor(std::log10(least) + 1e-9));
  const int to = std::max(from + 1, int(std::ceil(std::log10(most) - 1e-9)));
  for (int i = from; i <= to; ++i) axis.ticks.push_back(std::pow(10.0, i));
  axis.low = axis.ticks.front();
  axis.high = axis.ticks.back();
  return axis;
}

PlotPanel::PlotPanel(Drawing* drawing, double left, double top, double width, double height,
                     const std::string& title, PlotAxis x, PlotAxis y)
    : drawing_(drawing), left_(left), top_(top), width_(width), height_(height), x_(x), y_(y) {
  const auto words = [](const PlotAxis& axis, double tick) {
    return axis.format ? axis.format(tick) : Short(tick);
  };
  for (const double tick : x_.ticks) {
    const double at = left + width * x_.Place(tick);
    drawing->Add(Drawing::Line{{{at, top}, {at, top + height}}, kGrid, 1});
    drawing->Add(Drawing::Text{{at, top + height + 15}, words(x_, tick), 10.5, kFaint, Anchor::kMiddle});
  }
  for (const double tick : y_.ticks) {
    const double at = top + height * (1 - y_.Place(tick));
    drawing->Add(Drawing::Line{{{left, at}, {left + width, at}}, tick == 0 ? kFaint : kGrid, 1});
    drawing->Add(Drawing::Text{{left - 6, at + 3.5}, words(y_, tick), 10.5, kFaint, Anchor::kEnd});
  }
  const Points frame = {
      {left, top}, {left + width, top}, {left + width, top + height}, {left, top + height}, {left, top}};
  drawing->Add(Drawing::Line{frame, {170, 171, 180}, 1});
  drawing->Add(Drawing::Text{{left, top - 8}, title, 12, kInk});
}

Point PlotPanel::At(const Point& p) const {
  return {left_ + width_ * x_.Place(p.x()), top_ + height_ * (1 - y_.Place(p.y()))};
}

std::vector<PlotPanel::Points> PlotPanel::Inside(const Points& points) const {
  const double low = top_, high = top_ + height_;
  const auto inside = [&](const Point& p) { return p.y() >= low - 1e-9 && p.y() <= high + 1e-9; };
  std::vector<Points> stretches;
  bool open = false;
  for (size_t i = 0; i < points.size(); ++i) {
    const Point p = At(points[i]);
    if (i > 0) {
      // Where the segment crosses the frame's edges, in the order it meets them.
      const Point before = At(points[i - 1]);
      std::vector<double> crossings;
      for (const double edge : {low, high}) {
        const double s = (edge - before.y()) / (p.y() - before.y());
        if (std::isfinite(s) && s > 0 && s < 1) crossings.push_back(s);
      }
      std::sort(crossings.begin(), crossings.end());
      for (const double s : crossings) {
        const Point at = before + s * (p - before);
        if (!open) stretches.emplace_back();
        stretches.back().push_back({at.x(), std::clamp(at.y(), low, high)});
        open = !open;
      }
    }
    if (inside(p)) {
      if (!open) stretches.emplace_back();
      stretches.back().push_back(p);
      open = true;
    }
  }
  return stretches;
}

void PlotPanel::Line(const Points& points, Drawing::Colour colour, double width, double dash) {
  for (const Points& stretch : Inside(points)) drawing_->Add(Drawing::Line{stretch, colour, width, dash});
}

void PlotPanel::Area(const Points& points, Drawing::Colour colour) {
  if (points.empty()) return;
  const auto cut = [&](Point p) {
    p = At(p);
    p.y() = std::clamp(p.y(), top_, top_ + height_);
    return p;
  };
  Points outline{cut({points.front().x(), 0})};
  for (const Point& p : points) outline.push_back(cut(p));
  outline.push_back(cut({points.back().x(), 0}));
  drawing_->Add(Drawing::Fill{outline, colour});
}

void PlotPanel::Dots(const Points& points, Drawing::Colour colour, double radius) {
  for (const Point& p : points) {
    const Point at = At(p);
    if (at.y() < top_ - 1e-9 || at.y() > top_ + height_ + 1e-9) continue;
    drawing_->Add(Drawing::Fill{Arc(at, radius, 0, 2 * std::numbers::pi), colour});
  }
}

void PlotPanel::VerticalMark(double x, Drawing::Colour colour, const std::string& label) {
  const double at = left_ + width_ * x_.Place(x);
  drawing_->Add(Drawing::Line{{{at, top_}, {at, top_ + height_}}, colour, 1.2, 3});
  const bool right = at > left_ + 0.7 * width_;
  drawing_->Add(Drawing::Text{
      {at + (right ? -4 : 4), top_ + 13}, label, 10.5, colour, right ? Anchor::kEnd : Anchor::kStart});
}

}  // namespace lobe
