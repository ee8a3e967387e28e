#include "render/brdf_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "render/plot_panel.h"
#include "render/png.h"

namespace lobe {
namespace {

using Colour = Drawing::Colour;
using Points = PlotPanel::Points;

constexpr int kWidth = 1120, kHeight = 620;
constexpr int kPixelsPerUnit = 2;
constexpr Colour kInk = PlotPanel::kInk, kFaint = PlotPanel::kFaint;
constexpr Colour kExact{34, 34, 40}, kExactFill{120, 122, 135, 0.22};
constexpr Colour kLobe{208, 72, 30}, kNegative{24, 104, 196}, kNegativeFill{70, 150, 230, 0.45};
constexpr Colour kSecond{36, 130, 110}, kThird{130, 80, 170};

constexpr int kSlices = 4;
constexpr double kLeft = 62, kPanelWidth = 216, kPitch = 268, kPanelHeight = 178;
constexpr double kLeastShown = 1e-5;  ///< on logarithmic axes
constexpr double kTopRow = 132, kBottomRow = 402;

std::string Degrees(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.0f°", value);
  return buffer;
}
std::string Percent(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g%%", 100 * value);
  return buffer;
}

PlotAxis Angles(double low, double high, double step) {
  PlotAxis axis{low, high, false, {}, Degrees};
  for (double tick = low; tick <= high; tick += step) axis.ticks.push_back(tick);
  return axis;
}

/// A line and its name, in a row of them from `x` on; the next one's x.
double Legend(Drawing* drawing, double x, double y, Colour colour, const std::string& name, double dash = 0) {
  drawing->Add(Drawing::Line{{{x, y}, {x + 18, y}}, colour, 2, dash});
  drawing->Add(Drawing::Text{{x + 23, y + 4}, name, 10.5, kFaint});
  return x + 36 + 5.9 * double(name.size());
}

void DrawSlice(Drawing* drawing, int column, const BrdfPlot::Slice& slice) {
  const size_t count = slice.exact.size();
  Points exact, lobe, negative;
  double least = 0, most = 0;
  for (size_t i = 0; i < count; ++i) {
    const double theta = -90 + 180 * double(i) / double(count - 1);
    exact.emplace_back(theta, slice.exact[i]);
    lobe.emplace_back(theta, slice.lobe[i]);
    negative.emplace_back(theta, std::min(0.0, slice.lobe[i]));
    least = std::min(least, slice.lobe[i]);
    most = std::max({most, slice.exact[i], slice.lobe[i]});
  }
  PlotPanel panel(drawing, kLeft + kPitch * column, kTopRow, kPanelWidth, kPanelHeight,
                  "θi " + Degrees(slice.theta_i), Angles(-90, 90, 45), PlotAxis::Linear(least, most));
  panel.Area(exact, kExactFill);
  panel.Area(negative, kNegativeFill);
  panel.Line(exact, kExact, 1.6);
  panel.Line(lobe, kLobe, 2);
}

void DrawOverAngle(Drawing* drawing, const BrdfPlot& plot) {
  Points albedo, lobes, error, truncated, between;
  double most_albedo = 0, most_error = 0;
  for (const auto& a : plot.angles) {
    albedo.emplace_back(a.theta_i, a.albedo);
    lobes.emplace_back(a.theta_i, a.lobe_albedo);
    error.emplace_back(a.theta_i, a.error);
    truncated.emplace_back(a.theta_i, a.truncated);
    between.emplace_back(a.theta_i, a.between);
    most_albedo = std::max({most_albedo, a.albedo, a.lobe_albedo});
    most_error = std::max(most_error, a.error);
  }
  PlotPanel left(drawing, kLeft, kBottomRow, kPanelWidth, kPanelHeight, plot.part + ": albedo over θi",
                 Angles(0, 90, 30), PlotAxis::Linear(0, most_albedo));
  left.Line(albedo, kExact, 1.8);
  left.Dots(lobes, kLobe);
  const double y = kBottomRow + kPanelHeight + 31;
  double x = Legend(drawing, kLeft, y, kExact, "BRDF");
  drawing->Add(Drawing::Fill{Arc({x + 9, y}, 2.6, 0, 6.2832), kLobe});
  drawing->Add(Drawing::Text{{x + 23, y + 4}, "lobes", 10.5, kFaint});

  PlotAxis percent = PlotAxis::Linear(0, most_error);
  percent.format = Percent;
  PlotPanel right(drawing, kLeft + kPitch, kBottomRow, kPanelWidth, kPanelHeight,
                  plot.part + ": error over θi", Angles(0, 90, 30), percent);
  right.Line(truncated, kSecond, 1.6, 4);
  right.Line(between, kThird, 1.6);
  right.Line(error, kLobe, 2);
  x = Legend(drawing, kLeft + kPitch, y, kLobe, "all");
  x = Legend(drawing, x, y, kSecond, "truncation", 4);
  Legend(drawing, x, y, kThird, "knots");
}

/// A logarithmic axis of percent; what is smaller than its foot lies below the frame.
PlotAxis PercentDecades(double least, double most) {
  least = std::clamp(least, kLeastShown, 1.0);
  PlotAxis axis = PlotAxis::Decades(least, std::max(most, 2 * least));
  axis.format = Percent;
  return axis;
}

void DrawOverDegree(Drawing* drawing, const BrdfPlot& plot) {
  Points error, worst, negative, albedo;
  double least = 1, most = 0, least_albedo = 1, most_albedo = kLeastShown, most_albedo_error = 0;
  for (const auto& d : plot.degrees) {
    error.emplace_back(d.l_max, d.error);
    worst.emplace_back(d.l_max, d.worst);
    if (d.negative > 0) negative.emplace_back(d.l_max, d.negative);  // a logarithm has no place for 0
    albedo.emplace_back(d.l_max, d.albedo_error);
    for (const double v : {d.error, d.worst}) {
      if (v > 0) least = std::min(least, v);
      most = std::max(most, v);
    }
    most_albedo_error = std::max(most_albedo_error, d.albedo_error);
    for (const double v : {d.negative, d.albedo_error}) {
      if (v > 0) least_albedo = std::min(least_albedo, v);
      most_albedo = std::max(most_albedo, v);
    }
  }
  PlotAxis degree{0, 32, false, {0, 8, 16, 24, 32}, nullptr};
  const std::string chosen = "lmax " + std::to_string(plot.l_max);
  PlotPanel left(drawing, kLeft + 2 * kPitch, kBottomRow, kPanelWidth, kPanelHeight,
                 plot.part + ": error over lmax", degree, PercentDecades(least, most));
  if (plot.tolerance > 0) left.Line({{0, plot.tolerance}, {32, plot.tolerance}}, kFaint, 1.2, 3);
  left.VerticalMark(plot.l_max, kFaint, chosen);
  left.Line(worst, kSecond, 1.6, 4);
  left.Dots(worst, kSecond, 2);
  left.Line(error, kLobe, 2);
  left.Dots(error, kLobe);
  const double y = kBottomRow + kPanelHeight + 31;
  double x = Legend(drawing, kLeft + 2 * kPitch, y, kLobe, "by flux");
  x = Legend(drawing, x, y, kSecond, "worst", 4);
  if (plot.tolerance > 0) Legend(drawing, x, y, kFaint, "asked", 3);

  PlotPanel right(drawing, kLeft + 3 * kPitch, kBottomRow, kPanelWidth, kPanelHeight,
                  plot.part + ": negative part over lmax", degree, PercentDecades(least_albedo, most_albedo));
  right.VerticalMark(plot.l_max, kFaint, "");
  right.Line(negative, kNegative, 2);
  right.Dots(negative, kNegative);
  right.Line(albedo, kThird, 1.6);
  right.Dots(albedo, kThird, 2);
  x = Legend(drawing, kLeft + 3 * kPitch, y, kNegative, "negative flux");
  const bool tiny = most_albedo_error < kLeastShown;
  Legend(drawing, x, y, kThird, tiny ? "albedo error <0.001%" : "albedo error");
}

Drawing DrawBrdf(const BrdfPlot& plot) {
  Drawing drawing(kWidth, kHeight);
  drawing.Add(Drawing::Text{{28, 34}, plot.title, 18, kInk});
  for (size_t i = 0; i < plot.notes.size(); ++i) {
    drawing.Add(Drawing::Text{{28, 56 + 17 * double(i)}, plot.notes[i], 12, kFaint});
  }
  for (int i = 0; i < std::min<int>(kSlices, int(plot.slices.size())); ++i) {
    DrawSlice(&drawing, i, plot.slices[size_t(i)]);
  }
  const double y = kTopRow + kPanelHeight + 33;
  double x =
      Legend(&drawing, kLeft, y, kExact, "BRDF, 1/sr, over the outgoing angle in the plane of incidence");
  x = Legend(&drawing, x, y, kLobe, "its lobe");
  drawing.Add(Drawing::Fill{{{x, y - 5}, {x + 18, y - 5}, {x + 18, y + 5}, {x, y + 5}}, kNegativeFill});
  drawing.Add(Drawing::Text{{x + 23, y + 4}, "negative", 10.5, kFaint});
  if (!plot.angles.empty()) DrawOverAngle(&drawing, plot);
  if (!plot.degrees.empty()) DrawOverDegree(&drawing, plot);
  return drawing;
}

}  // namespace

std::string BrdfSvg(const BrdfPlot& plot) { return DrawBrdf(plot).Svg(); }

void WriteBrdfPng(const BrdfPlot& plot, const std::string& path) {
  const Drawing drawing = DrawBrdf(plot);
  WritePngBytes(drawing.width() * kPixelsPerUnit, drawing.height() * kPixelsPerUnit,
                drawing.Rasterise(kPixelsPerUnit), path);
}

}  // namespace lobe
