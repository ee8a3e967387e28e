#pragma once

#include <string>
#include <vector>

namespace lobe {

/// What a picture of a BRDF beside its lobes shows. Errors are fractions; angles degrees.
struct BrdfPlot {
  std::string title;
  std::vector<std::string> notes;  ///< lines under the title

  /// The plane of incidence at one theta_i: values in 1/sr over theta_o from -90 to 90, equally spaced;
  /// positive on the side of the mirror direction.
  struct Slice {
    double theta_i = 0;
    std::vector<double> exact, lobe;
  };
  std::vector<Slice> slices;  ///< four are drawn

  std::string part;  ///< "gloss" or "base": what all that follows is of
  struct AtAngle {
    double theta_i, albedo, lobe_albedo, error, truncated, between;
  };
  std::vector<AtAngle> angles;  ///< rising theta_i

  struct AtDegree {
    int l_max;
    double error, worst, negative, albedo_error;
  };
  std::vector<AtDegree> degrees;  ///< rising l_max
  int l_max = 0;                  ///< the degree of the lobes above
  double tolerance = 0;           ///< --lobe-error; 0: none is drawn
};

/// As SVG text, and as PNG of twice as many pixels as SVG units. Throws InputError if it cannot be written.
std::string BrdfSvg(const BrdfPlot& plot);
void WriteBrdfPng(const BrdfPlot& plot, const std::string& path);

}  // namespace lobe
