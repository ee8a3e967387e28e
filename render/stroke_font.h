#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace lobe {

/// A plain single-stroke alphabet of our own for labels in pictures: ASCII letters, digits, common
/// punctuation and the signs plots want (degree, times, square, theta, phi). `text` is UTF-8; a
/// character it lacks becomes a box.

/// Pen strokes (polylines) of a text, y down, baseline at y = 0 from x = 0; a dot is a stroke of two
/// equal points. `size` as of a font: capitals are 0.72 of it high.
std::vector<std::vector<Eigen::Vector2d>> StrokeText(const std::string& text, double size);

/// How far the pen moves.
double StrokeTextWidth(const std::string& text, double size);

}  // namespace lobe
