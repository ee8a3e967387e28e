#include "render/drawing.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/stroke_font.h"

namespace lobe {
namespace {

using Point = Drawing::Point;
using ::testing::HasSubstr;
using ::testing::Not;

/// Ink on white in units of full black pixels; for black shapes that is their area.
double Ink(const Drawing& drawing, int scale) {
  double ink = 0;
  const auto bytes = drawing.Rasterise(scale);
  for (size_t i = 0; i < bytes.size(); i += 3) ink += (255 - bytes[i]) / 255.0;
  return ink;
}

// Bytes round coverage to 1/255, and rows are sampled four times: 0.5 % of these shapes.
constexpr double kAreaTolerance = 0.005;

TEST(RasterTest, FilledPolygonsCoverTheirArea) {
  for (const int scale : {1, 3}) {
    Drawing disc(60, 60);
    disc.Add(Drawing::Fill{Arc({30.3, 29.6}, 20, 0, 2 * std::numbers::pi), {}});
    const double area = std::numbers::pi * 400 * scale * scale;
    EXPECT_NEAR(Ink(disc, scale), area, kAreaTolerance * area);
  }
}

TEST(RasterTest, LinesHaveTheirWidthInEveryDirection) {
  for (const Point& end : {Point(50, 10), Point(10, 50), Point(43.7, 31.2)}) {
    Drawing drawing(60, 60);
    drawing.Add(Drawing::Line{{{10, 10}, end}, {}, 3});
    const double length = (end - Point(10, 10)).norm();
    const double area = 3 * length + std::numbers::pi * 2.25;  // round ends
    EXPECT_NEAR(Ink(drawing, 1), area, 0.02 * area);
  }
}

TEST(RasterTest, DashesLeaveHalfOut) {
  Drawing whole(220, 20), dashed(220, 20);
  whole.Add(Drawing::Line{{{10, 10}, {70, 10}, {210, 10}}, {}, 2});
  dashed.Add(Drawing::Line{{{10, 10}, {70, 10}, {210, 10}}, {}, 2, 10});
  EXPECT_NEAR(Ink(dashed, 2) / Ink(whole, 2), 0.5, 0.1);
}

TEST(RasterTest, ShapesOutsideAreCutNotCrashed) {
  Drawing drawing(10, 10);
  drawing.Add(Drawing::Fill{{{-50, -50}, {60, -50}, {60, 60}, {-50, 60}}, {}});
  drawing.Add(Drawing::Line{{{-100, 5}, {300, 5}}, {255, 255, 255}, 2});
  drawing.Add(Drawing::Line{{{-100, -90}, {-80, -95}}, {255, 255, 255}, 2});
  EXPECT_NEAR(Ink(drawing, 1), 80, 0.01);
}

TEST(RasterTest, AlphaMixes) {
  Drawing drawing(4, 4);
  drawing.Add(Drawing::Fill{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {0, 0, 0, 0.25}});
  EXPECT_EQ(drawing.Rasterise(1)[0], 191);
}

TEST(RasterTest, PicturesKeepTheirPixelsApart) {
  Drawing drawing(4, 2);
  drawing.Add(Drawing::Picture{{0, 0}, 4, 2, 2, 1, {10, 20, 30, 255, 40, 50, 60, 255}});
  const auto bytes = drawing.Rasterise(1);
  EXPECT_EQ(bytes[0], 10);
  EXPECT_EQ(bytes[3 * 1 + 2], 30);
  EXPECT_EQ(bytes[3 * 2], 40);
  EXPECT_EQ(bytes[3 * 7 + 1], 50);
}

TEST(StrokeFontTest, EveryPrintableSignIsItsOwnAndKeepsItsLine) {
  const std::string signs =
      "0123456789ABCDEFGHIJKLMNPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz.,:;-_+=%()[]/|<>!?'\"#*&";
  std::vector<std::vector<std::vector<Point>>> shapes;
  for (const char sign : signs) {
    const auto strokes = StrokeText(std::string(1, sign), 100);
    ASSERT_FALSE(strokes.empty()) << sign;
    for (const auto& stroke : strokes) {
      ASSERT_GE(stroke.size(), 2u) << sign;
      for (const Point& p : stroke) {
        EXPECT_GE(p.x(), 0) << sign;
        EXPECT_LE(p.x(), 4 * 12 + 1e-9) << sign;
        EXPECT_GE(p.y(), -72 - 1e-9) << sign;
        EXPECT_LE(p.y(), 24 + 1e-9) << sign;
      }
    }
    for (size_t i = 0; i < shapes.size(); ++i) EXPECT_NE(shapes[i], strokes) << signs[i] << " and " << sign;
    shapes.push_back(strokes);
  }
}

TEST(StrokeFontTest, WidthAddsUpAndUnknownSignsAreBoxes) {
  // Two signs are their own widths and one gap of 1.7 grid steps of 0.12 sizes.
  EXPECT_NEAR(StrokeTextWidth("AB", 10), StrokeTextWidth("A", 10) + StrokeTextWidth("B", 10) + 1.7 * 1.2,
              1e-9);
  EXPECT_EQ(StrokeTextWidth("", 10), 0);
  const auto box = StrokeText("\xe4\xb8\xad", 10);  // a Chinese character
  ASSERT_EQ(box.size(), 1u);
  EXPECT_EQ(StrokeText("\xff", 10), box) << "a stray byte";
  EXPECT_EQ(StrokeText("\xe4\xb8", 10), box) << "a cut-off character";
  EXPECT_NE(StrokeText("φ", 10), box);
  EXPECT_NE(StrokeText("°", 10), box);
}

TEST(SvgTest, TextIsEscaped) {
  Drawing drawing(10, 10);
  drawing.Add(Drawing::Text{{1, 2}, "a<b & \"c\"\x01", 12, {}});
  const std::string svg = drawing.Svg();
  EXPECT_THAT(svg, HasSubstr("a&lt;b &amp; &quot;c&quot; <"));
  EXPECT_THAT(svg, Not(HasSubstr("\x01")));
}

TEST(SvgTest, ShapesCarryTheirNumbers) {
  Drawing drawing(10, 20);
  drawing.Add(Drawing::Line{{{1, 2.5}, {3.25, 4}}, {255, 0, 16, 0.5}, 1.5, 4});
  const std::string svg = drawing.Svg();
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 10 20\""));
  EXPECT_THAT(svg, HasSubstr("points=\"1,2.5 3.25,4\""));
  EXPECT_THAT(svg, HasSubstr("stroke=\"#ff0010\" stroke-opacity=\"0.5\""));
  EXPECT_THAT(svg, HasSubstr("stroke-dasharray=\"4\""));
}

}  // namespace
}  // namespace lobe
