// The first functions of Lobe's hemisphere basis, seen from above: a disc is the hemisphere looked at along
// z, so that each function is a polynomial in the picture's x and y. Red is positive, blue negative.
//
//     01_plot_harmonics harmonics.svg
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "sh/hemisphere_basis.h"

namespace {

constexpr int kLMax = 4;
constexpr int kRows = 72;    // of pixels per disc
constexpr int kLevels = 12;  // of colour, each way
constexpr int kSize = 144;   // of a disc, in SVG units
constexpr int kGap = 22;

// Colour by level, -kLevels..kLevels: blue, white, red.
std::string Colour(int level) {
  const double t = std::abs(level) / double(kLevels);
  const int fade = int(std::lround(255 * (1 - t) + 30 * t));
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", level >= 0 ? 225 + int(30 * (1 - t)) : fade, fade,
                level < 0 ? 225 + int(30 * (1 - t)) : fade);
  return text;
}

// H_k over the disc as levels, row by row from the top; kLevels + 1 outside it.
std::vector<int> DiscLevels(const lobe::HemisphereBasis<double>& basis, int k) {
  std::vector<double> value(kRows * kRows, 0), h(basis.size());
  double peak = 0;
  for (int i = 0; i < kRows * kRows; ++i) {
    const double x = 2 * (i % kRows + 0.5) / kRows - 1, y = 1 - 2 * (i / kRows + 0.5) / kRows;
    if (x * x + y * y > 1) continue;
    basis.Evaluate(x, y, std::sqrt(1 - x * x - y * y), h.data());
    value[i] = h[k];
    peak = std::max(peak, std::abs(h[k]));
  }
  std::vector<int> levels(kRows * kRows, kLevels + 1);
  for (int i = 0; i < kRows * kRows; ++i) {
    const double x = 2 * (i % kRows + 0.5) / kRows - 1, y = 1 - 2 * (i / kRows + 0.5) / kRows;
    if (x * x + y * y <= 1) levels[i] = int(std::lround(kLevels * value[i] / peak));
  }
  return levels;
}

// One path for each colour, a rectangle for each run of it.
void DrawDisc(std::ostream& svg, const std::vector<int>& levels, int left, int top) {
  constexpr int kPixel = kSize / kRows;
  std::map<int, std::ostringstream> paths;
  for (int row = 0; row < kRows; ++row) {
    for (int begin = 0, end; begin < kRows; begin = end) {
      const int level = levels[row * kRows + begin];
      for (end = begin + 1; end < kRows && levels[row * kRows + end] == level; ++end) {
      }
      if (level > kLevels || level == 0) continue;  // paper white
      const int width = (end - begin) * kPixel;
      paths[level] << 'M' << left + begin * kPixel << ' ' << top + row * kPixel << 'h' << width << 'v'
                   << kPixel << 'h' << -width << 'z';
    }
  }
  for (const auto& [level, path] : paths) {
    svg << "<path fill='" << Colour(level) << "' d='" << path.str() << "'/>\n";
  }
  svg << "<circle cx='" << left + kSize / 2 << "' cy='" << top + kSize / 2 << "' r='" << kSize / 2
      << "' fill='none' stroke='#444'/>\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: 01_plot_harmonics OUTPUT.svg\n";
    return 2;
  }
  const lobe::HemisphereBasis<double> basis(kLMax);
  const int width = (kLMax + 1) * (kSize + kGap) + kGap, height = (kLMax + 1) * (kSize + 2 * kGap) + kGap;
  std::ofstream svg(argv[1]);
  svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width << "' height='" << height
      << "' font-family='sans-serif' font-size='13' text-anchor='middle' shape-rendering='crispEdges'>\n"
      << "<rect width='100%' height='100%' fill='white'/>\n";
  for (int l = 0; l <= kLMax; ++l) {
    // m = -l, -l + 2, ..., l: the others are odd in z, and not part of the basis.
    for (int m = -l; m <= l; m += 2) {
      const int left = width / 2 + (m * (kSize + kGap)) / 2 - kSize / 2;
      const int top = kGap + l * (kSize + 2 * kGap);
      DrawDisc(svg, DiscLevels(basis, lobe::CoefficientIndex(l, m)), left, top);
      svg << "<text x='" << left + kSize / 2 << "' y='" << top + kSize + 16 << "'>l = " << l << ", m = " << m
          << "</text>\n";
    }
  }
  svg << "</svg>\n";
  if (!svg.flush()) {
    std::cerr << argv[1] << ": cannot be written\n";
    return 1;
  }
  std::cout << basis.size() << " functions of degree 0 to " << kLMax << " in " << argv[1] << "\n";
}
