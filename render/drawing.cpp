#include "render/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "render/png.h"

namespace lobe {
namespace {

/// A hundredth of a unit is below what anyone sees, and keeps files small.
std::string Number(double v) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.2f", v);
  std::string text = buffer;
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string Paint(const char* property, const Drawing::Colour& c) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%s=\"#%02x%02x%02x\"", property, c.r, c.g, c.b);
  std::string text = buffer;
  if (c.alpha < 1) text += std::string(" ") + property + "-opacity=\"" + Number(c.alpha) + "\"";
  return text;
}

std::string Points(const std::vector<Drawing::Point>& points) {
  std::string text;
  for (const auto& p : points) {
    if (!text.empty()) text += ' ';
    text += Number(p.x()) + "," + Number(p.y());
  }
  return text;
}

std::string Escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      // Control characters may not stand in XML even when escaped.
      default:
        escaped += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
  }
  return escaped;
}

/// RFC 4648, section 4.
std::string Base64(const std::vector<uint8_t>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t left = bytes.size() - i;
    const uint32_t three =
        bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    for (size_t k = 0; k < 4; ++k) text += k <= left ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

struct SvgWriter {
  std::string operator()(const Drawing::Line& line) const {
    std::string text = "<polyline points=\"" + Points(line.points) + "\" fill=\"none\" " +
                       Paint("stroke", line.colour) + " stroke-width=\"" + Number(line.width) +
                       "\" stroke-linejoin=\"round\"";
    if (line.dash > 0) text += " stroke-dasharray=\"" + Number(line.dash) + "\"";
    return text + "/>\n";
  }
  std::string operator()(const Drawing::Fill& fill) const {
    return "<polygon points=\"" + Points(fill.points) + "\" " + Paint("fill", fill.colour) + "/>\n";
  }
  std::string operator()(const Drawing::Text& t) const {
    static constexpr const char* kAnchors[] = {"start", "middle", "end"};
    return "<text x=\"" + Number(t.at.x()) + "\" y=\"" + Number(t.at.y()) + "\" font-size=\"" +
           Number(t.size) + "\" text-anchor=\"" + kAnchors[static_cast<int>(t.anchor)] + "\" " +
           Paint("fill", t.colour) + ">" + Escape(t.text) + "</text>\n";
  }
  std::string operator()(const Drawing::Picture& p) const {
    return "<image x=\"" + Number(p.corner.x()) + "\" y=\"" + Number(p.corner.y()) + "\" width=\"" +
           Number(p.width) + "\" height=\"" + Number(p.height) +
           "\" preserveAspectRatio=\"none\" href=\"data:image/png;base64," +
           Base64(EncodePng(p.columns, p.rows, 4, p.rgba)) + "\"/>\n";
  }
};

}  // namespace

std::string Drawing::Svg() const {
  const std::string w = std::to_string(width_), h = std::to_string(height_);
  std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h +
                     "\" viewBox=\"0 0 " + w + " " + h +
                     "\" font-family=\"Helvetica, Arial, sans-serif\">\n"
                     "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  for (const Shape& shape : shapes_) text += std::visit(SvgWriter(), shape);
  return text + "</svg>\n";
}

std::vector<Drawing::Point> Arc(const Drawing::Point& centre, double radius, double a, double b) {
  // Chords leave the circle by at most 0.02 units, which nobody sees.
  const double step = 2 * std::acos(1 - std::min(0.5, 0.02 / radius));
  const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(b - a) / step)));
  std::vector<Drawing::Point> points;
  for (int i = 0; i <= steps; ++i) {
    const double t = a + (b - a) * i / steps;
    points.emplace_back(centre.x() + radius * std::cos(t), centre.y() - radius * std::sin(t));
  }
  return points;
}

}  // namespace lobe
