#include "render/brdf_plot.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/plot_panel.h"

namespace lobe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(PlotAxisTest, TicksAreRoundAndHoldTheRange) {
  for (const double most : {0.00013, 0.7, 1.0, 3.7, 129.0, 5e6}) {
    const PlotAxis axis = PlotAxis::Linear(0, most);
    EXPECT_EQ(axis.low, 0);
    EXPECT_GE(axis.high, most * (1 - 1e-9));
    EXPECT_LE(axis.high, 2 * most);
    EXPECT_GE(axis.ticks.size(), 3u);
    EXPECT_LE(axis.ticks.size(), 7u);
    EXPECT_EQ(axis.ticks.front(), 0);
  }
  const PlotAxis below = PlotAxis::Linear(-0.4, 10);
  EXPECT_LT(below.low, -0.4);
  EXPECT_GT(below.low, -1);
  const PlotAxis decades = PlotAxis::Decades(0.02, 0.9);
  EXPECT_EQ(decades.ticks.size(), 3u);
  EXPECT_NEAR(decades.Place(0.1), 0.5, 1e-9);
  EXPECT_EQ(PlotAxis::Linear(0, 0).high, 1) << "a black BRDF still has an axis";
}

TEST(PlotPanelTest, CurvesAreCutAtTheFrame) {
  Drawing drawing(200, 200);
  PlotPanel panel(&drawing, 50, 50, 100, 100, "", PlotAxis{0, 1, false, {}, nullptr},
                  PlotAxis{0, 1, false, {}, nullptr});
  const size_t before = drawing.shapes().size();
  panel.Line({{0, -1}, {0.5, 3}, {1, -1}}, {});  // in, out at the top, in again
  ASSERT_EQ(drawing.shapes().size(), before + 2);
  for (size_t i = before; i < drawing.shapes().size(); ++i) {
    for (const auto& p : std::get<Drawing::Line>(drawing.shapes()[i]).points) {
      EXPECT_GE(p.y(), 50 - 1e-9);
      EXPECT_LE(p.y(), 150 + 1e-9);
    }
  }
  panel.Dots({{0.5, 2}}, {});
  EXPECT_EQ(drawing.shapes().size(), before + 2) << "a dot outside is not drawn";
}

BrdfPlot Example() {
  BrdfPlot plot;
  plot.title = "a <test> & more";
  plot.part = "gloss";
  for (const double theta : {0.0, 30.0, 60.0, 80.0}) {
    BrdfPlot::Slice slice{theta, {}, {}};
    for (int i = 0; i <= 180; ++i) {
      slice.exact.push_back(std::exp(-0.002 * (i - 90 - theta) * (i - 90 - theta)));
      slice.lobe.push_back(slice.exact.back() - 0.1);
    }
    plot.slices.push_back(slice);
    plot.angles.push_back({theta, 0.9, 0.9, 0.2, 0.19, 0.05});
  }
  for (const int l : {0, 8, 16}) plot.degrees.push_back({l, 0.5 / (l + 1), 0.9, l == 0 ? 0 : 0.1, 1e-5});
  plot.l_max = 8;
  plot.tolerance = 0.1;
  return plot;
}

TEST(BrdfPlotTest, ShowsSlicesAnglesAndDegrees) {
  const std::string svg = BrdfSvg(Example());
  for (const char* words : {"a &lt;test&gt; &amp; more", "θi 60°", "gloss: albedo over θi",
                            "gloss: error over lmax", "lmax 8", "negative"}) {
    EXPECT_THAT(svg, HasSubstr(words));
  }
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

// A base has no degree to choose: those panels stay out.
TEST(BrdfPlotTest, LeavesOutWhatThereIsNot) {
  BrdfPlot plot = Example();
  plot.degrees.clear();
  EXPECT_THAT(BrdfSvg(plot), Not(HasSubstr("over lmax")));
}

}  // namespace
}  // namespace lobe
