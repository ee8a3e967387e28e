#pragma once

#include <string>

#include <Eigen/Core>

namespace lobe {

/// Pictures of one lobe. `coefficients`: rows over the hemisphere basis, 3 columns, local frame.

/// Polar slices through the azimuth of the peak and across it (radius = luminance; negative parts dashed and
/// marked) and a disc map of the hemisphere seen from above, with numbers. SVG text.
std::string LobeSvg(const Eigen::MatrixXd& coefficients, const std::string& title);
/// The same picture as PNG.
void WriteLobePng(const Eigen::MatrixXd& coefficients, const std::string& title, const std::string& path);
/// A surface: distance from the centre = luminance, scaled so that the peak is `size` metres, coloured by
/// radiance; negative parts blue. Placed at `origin` in the frame of `normal`. Throws InputError.
void WriteLobeGlb(const Eigen::MatrixXd& coefficients, const Eigen::Vector3f& origin,
                  const Eigen::Vector3f& normal, float size, const std::string& path);

}  // namespace lobe
