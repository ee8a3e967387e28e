#include "render/lobe_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "render/drawing.h"
#include "render/false_colour.h"
#include "render/lobe_figures.h"
#include "render/png.h"

namespace lobe {
namespace {

using Point = Drawing::Point;
using Colour = Drawing::Colour;
using Anchor = Drawing::Anchor;

constexpr double kPi = std::numbers::pi;
constexpr int kWidth = 1000, kHeight = 400;
constexpr int kPixelsPerUnit = 2;  ///< of the PNG

constexpr Colour kInk{34, 34, 40}, kFaint{110, 110, 122}, kGrid{214, 215, 222};
constexpr Colour kLobe{196, 72, 36}, kLobeFill{236, 130, 60, 0.28};
constexpr Colour kNegative{24, 104, 196}, kNegativeFill{70, 150, 230, 0.22};

std::string Format(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}
std::string Short(double value) { return Format("%.3g", value); }

/// The next of 1, 2, 2.5, 5 times a power of ten that is at least `value`.
double RoundUp(double value) {
  if (!(value > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 2.5, 5.0}) {
    if (value <= step * power * (1 + 1e-9)) return step * power;
  }
  return 10 * power;
}

/// Luminance along the half circle from azimuth `phi` over the pole to phi + pi. Angle t: 0 at the
/// horizon towards phi, pi at the other.
std::vector<double> Slice(const LobeReader& lobe, double phi) {
  const int steps = std::max(180, 12 * lobe.l_max());
  std::vector<double> values;
  for (int i = 0; i <= steps; ++i) {
    const double t = kPi * i / steps, s = std::cos(t);
    values.push_back(lobe.Luminance({s * std::cos(phi), s * std::sin(phi), std::sin(t)}));
  }
  return values;
}

double LargestMagnitude(const std::vector<double>& values) {
  double largest = 0;
  for (const double v : values) largest = std::max(largest, std::abs(v));
  return largest;
}

/// Rings of radiance and spokes every 30 degrees of theta.
void DrawPolarGrid(Drawing* drawing, const Point& centre, double radius, double full_scale, int phi_right) {
  constexpr int kRings = 4;
  for (int k = 1; k <= kRings; ++k) {
    drawing->Add(Drawing::Line{Arc(centre, radius * k / kRings, 0, kPi), kGrid, k == kRings ? 1.4 : 1.0});
  }
  for (int theta = -90; theta <= 90; theta += 30) {
    const double t = kPi / 2 - theta * kPi / 180;
    const Point direction(std::cos(t), -std::sin(t));
    drawing->Add(Drawing::Line{{centre, centre + radius * direction}, kGrid, 1});
    Point at = centre + (radius + 9) * direction;
    const Anchor anchor = theta == 0 ? Anchor::kMiddle : theta > 0 ? Anchor::kStart : Anchor::kEnd;
    if (std::abs(theta) == 90) at.y() -= 4;
    drawing->Add(Drawing::Text{at, std::to_string(std::abs(theta)) + "°", 11, kFaint, anchor});
  }
  for (int k = 0; k <= kRings; k += 2) {
    drawing->Add(Drawing::Text{centre + Point(radius * k / kRings, 16), Short(full_scale * k / kRings), 10.5,
                               kFaint, Anchor::kMiddle});
  }
  for (const int side : {1, -1}) {
    const int phi = (side > 0 ? phi_right : phi_right + 180) % 360;
    drawing->Add(Drawing::Text{centre + Point(side * radius, 36), "φ " + std::to_string(phi) + "°", 12.5,
                               kInk, Anchor::kMiddle});
  }
}

/// Runs of one sign as filled outlines from the centre; negative ones by magnitude, dashed.
void DrawSlice(Drawing* drawing, const Point& centre, double radius, double full_scale,
               const std::vector<double>& values) {
  const auto at = [&](size_t i) -> Point {
    const double t = kPi * double(i) / double(values.size() - 1),
                 r = std::abs(values[i]) / full_scale * radius;
    return centre + Point(r * std::cos(t), -r * std::sin(t));
  };
  for (size_t begin = 0; begin < values.size();) {
    const bool negative = values[begin] < 0;
    size_t end = begin;
    std::vector<Point> outline{centre};
    while (end < values.size() && (values[end] < 0) == negative) outline.push_back(at(end++));
    outline.push_back(centre);
    drawing->Add(Drawing::Fill{outline, negative ? kNegativeFill : kLobeFill});
    // On the horizon the outline ends; the spoke back to the centre is not part of the curve.
    if (begin == 0) outline.erase(outline.begin());
    if (end == values.size()) outline.pop_back();
    drawing->Add(
        Drawing::Line{outline, negative ? kNegative : kLobe, negative ? 1.5 : 2.0, negative ? 4.0 : 0.0});
    begin = end;
  }
}

/// Colour of a luminance: false colour up to `peak`, greyed blue below zero.
std::array<unsigned char, 3> MapColour(double value, double peak) {
  if (value >= 0 || peak <= 0) return FalseColourBytes(peak > 0 ? value / peak : 0);
  const double t = std::min(1.0, 0.35 + 4 * -value / peak);  // full blue at a sixth of the peak (chosen)
  return {static_cast<unsigned char>(std::lround(std::lerp(10, 70, t))),
          static_cast<unsigned char>(std::lround(std::lerp(10, 170, t))),
          static_cast<unsigned char>(std::lround(std::lerp(36, 250, t)))};
}

/// The hemisphere from above: x to the right, y up, orthographic, so that equal areas of the picture
/// carry equal shares of the flux per radiance.
void DrawMap(Drawing* drawing, const LobeReader& lobe, const LobeFigures& figures, const Point& centre,
             int radius) {
  const int n = 2 * radius * kPixelsPerUnit;
  Drawing::Picture map{centre - Point(radius, radius), 2.0 * radius, 2.0 * radius, n, n, {}};
  map.rgba.resize(size_t(4) * n * n);
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column < n; ++column) {
      double x = (column + 0.5) * 2 / n - 1, y = 1 - (row + 0.5) * 2 / n;
      const double r = std::hypot(x, y);
      const double coverage = std::clamp((1 - r) * n / 2 + 0.5, 0.0, 1.0);
      if (coverage == 0) continue;
      if (r > 1) x /= r, y /= r;
      const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
      const auto colour = MapColour(lobe.Luminance({x, y, z}), figures.peak);
      unsigned char* pixel = &map.rgba[4 * (size_t(row) * n + column)];
      std::copy(colour.begin(), colour.end(), pixel);
      pixel[3] = static_cast<unsigned char>(std::lround(255 * coverage));
    }
  }
  drawing->Add(std::move(map));
  for (const int theta : {30, 60}) {
    const double r = radius * std::sin(theta * kPi / 180);
    // Light on dark and dark on light: two strokes are seen on any colour.
    drawing->Add(Drawing::Line{Arc(centre, r, 0, 2 * kPi), {0, 0, 0, 0.18}, 2.4});
    drawing->Add(Drawing::Line{Arc(centre, r, 0, 2 * kPi), {255, 255, 255, 0.5}, 1});
  }
  drawing->Add(Drawing::Line{Arc(centre, radius, 0, 2 * kPi), kFaint, 1.2});
  const Point peak = centre + radius * Point(figures.peak_direction.x(), -figures.peak_direction.y());
  drawing->Add(Drawing::Line{Arc(peak, 5.5, 0, 2 * kPi), {20, 20, 20, 0.75}, 3.2});
  drawing->Add(Drawing::Line{Arc(peak, 5.5, 0, 2 * kPi), {255, 255, 255}, 1.6});
  drawing->Add(Drawing::Text{centre + Point(radius + 9, 4), "x", 13, kInk, Anchor::kStart});
  drawing->Add(Drawing::Text{centre + Point(0, -radius - 9), "y", 13, kInk, Anchor::kMiddle});
  drawing->Add(Drawing::Text{centre + Point(0, radius + 16), "seen from above, rings at θ 30° and 60°", 10.5,
                             kFaint, Anchor::kMiddle});
}

void DrawColourBar(Drawing* drawing, const Point& corner, double width, double peak) {
  constexpr int kColumns = 256;
  Drawing::Picture bar{corner, width, 10, kColumns, 1, {}};
  for (int i = 0; i < kColumns; ++i) {
    const auto colour = FalseColourBytes((i + 0.5) / kColumns);
    bar.rgba.insert(bar.rgba.end(), {colour[0], colour[1], colour[2], 255});
  }
  drawing->Add(std::move(bar));
  for (int k = 0; k <= 2; ++k) {
    const Point at = corner + Point(width * k / 2, 24);
    drawing->Add(Drawing::Text{at, Short(std::max(0.0, peak) * k / 2), 10.5, kFaint, Anchor::kMiddle});
  }
}

Drawing DrawLobe(const Eigen::MatrixXd& coefficients, const std::string& title) {
  const LobeReader lobe(coefficients);
  const LobeFigures figures = MeasureLobe(coefficients);
  // Through the peak, in whole degrees, so that neither the picture nor its scale misses it.
  const int phi = static_cast<int>(std::lround(figures.peak_phi_degrees())) % 360;
  const auto along = Slice(lobe, phi * kPi / 180), across = Slice(lobe, (phi + 90) * kPi / 180);
  const double full_scale = RoundUp(std::max(LargestMagnitude(across), LargestMagnitude(along)));

  Drawing drawing(kWidth, kHeight);
  drawing.Add(Drawing::Text{{28, 36}, title, 18, kInk});
  constexpr double kRadius = 138, kFloor = 246;
  const Point left(196, kFloor), middle(538, kFloor), right(844, 170);
  DrawPolarGrid(&drawing, left, kRadius, full_scale, phi);
  DrawSlice(&drawing, left, kRadius, full_scale, along);
  DrawPolarGrid(&drawing, middle, kRadius, full_scale, phi + 90);
  DrawSlice(&drawing, middle, kRadius, full_scale, across);
  DrawMap(&drawing, lobe, figures, right, 100);
  DrawColourBar(&drawing, {right.x() - 100, 312}, 200, figures.peak);

  drawing.Add(Drawing::Line{{{28, 326}, {50, 326}}, kLobe, 2});
  drawing.Add(Drawing::Text{{58, 330}, "luminance, W/(m² sr)", 11.5, kFaint});
  if (figures.negative_fraction > 0) {
    drawing.Add(Drawing::Line{{{210, 326}, {232, 326}}, kNegative, 1.5, 4});
    drawing.Add(Drawing::Text{{240, 330}, "negative (magnitude)", 11.5, kFaint});
  }
  const Rgb& flux = figures.flux;
  drawing.Add(Drawing::Text{{28, 362},
                            "flux R " + Short(flux[0]) + ", G " + Short(flux[1]) + ", B " + Short(flux[2]) +
                                " W/m²    peak " + Short(figures.peak) + " W/(m² sr) at θ " +
                                Format("%.1f", figures.peak_theta_degrees()) + "°, φ " +
                                Format("%.1f", figures.peak_phi_degrees()) + "°",
                            13,
                            kInk});
  drawing.Add(Drawing::Text{{28, 384},
                            "negative part " + Format("%.2f", 100 * figures.negative_fraction) +
                                " %    degree " + std::to_string(lobe.l_max()) + ", coefficients a channel " +
                                std::to_string(coefficients.rows()),
                            13,
                            kInk});
  return drawing;
}

}  // namespace

std::string LobeSvg(const Eigen::MatrixXd& coefficients, const std::string& title) {
  return DrawLobe(coefficients, title).Svg();
}

void WriteLobePng(const Eigen::MatrixXd& coefficients, const std::string& title, const std::string& path) {
  const Drawing drawing = DrawLobe(coefficients, title);
  WritePngBytes(drawing.width() * kPixelsPerUnit, drawing.height() * kPixelsPerUnit,
                drawing.Rasterise(kPixelsPerUnit), path);
}

}  // namespace lobe
