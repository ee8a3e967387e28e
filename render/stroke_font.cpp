#include "render/stroke_font.h"

#include <algorithm>
#include <cstdint>

namespace lobe {
namespace {

/// Strokes on a grid, separated by spaces; a point is two characters: x, then y from the baseline up,
/// with 'a' and 'b' one and two below it. Capitals are 6 high, small letters 4.
struct Glyph {
  char32_t code;
  const char* strokes;
};

constexpr Glyph kGlyphs[] = {
    {U'0', "100105163645413010"},
    {U'1', "152620 1030"},
    {U'2', "05163645440040"},
    {U'3', "05163645443313 334241301001"},
    {U'4', "30360242"},
    {U'5', "460603334241301001"},
    {U'6', "453616050110304142331302"},
    {U'7', "06464520"},
    {U'8', "130405163645443313 1302011030414233"},
    {U'9', "011030414536160504133344"},
    {U'A', "002640 1333"},
    {U'B', "00063645443303 3342413000"},
    {U'C', "4536160501103041"},
    {U'D', "00062644422000"},
    {U'E', "46060040 0333"},
    {U'F', "460600 0333"},
    {U'G', "45361605011030414323"},
    {U'H', "0006 4046 0343"},
    {U'I', "0006"},
    {U'J', "3631201001"},
    {U'K', "0006 4602 1340"},
    {U'L', "060040"},
    {U'M', "0006234640"},
    {U'N', "00064046"},
    {U'O', "100105163645413010"},
    {U'P', "00063645443303"},
    {U'Q', "100105163645413010 2240"},
    {U'R', "00063645443303 2340"},
    {U'S', "453616050413334241301001"},
    {U'T', "0646 2620"},
    {U'U', "060110304146"},
    {U'V', "062046"},
    {U'W', "0610243046"},
    {U'X', "0046 0640"},
    {U'Y', "062346 2320"},
    {U'Z', "06460040"},
    {U'a', "3430 3324140301102031"},
    {U'b', "0600 0110203133241403"},
    {U'c', "3324140301102031"},
    {U'd', "3630 3324140301102031"},
    {U'e', "02323324140301102031"},
    {U'f', "261510 0424"},
    {U'g', "343a2b1b0a 3324140301102031"},
    {U'h', "0600 0314243330"},
    {U'i', "0400 0606"},
    {U'j', "141a0b 1616"},
    {U'k', "0600 3401 1230"},
    {U'l', "060110"},
    {U'm', "0004 03142320 23344340"},
    {U'n', "0004 0314243330"},
    {U'o', "100103142433312010"},
    {U'p', "040b 0314243331201001"},
    {U'q', "343b 3324140301102031"},
    {U'r', "0004 031424"},
    {U's', "33241403122231201001"},
    {U't', "161120 0424"},
    {U'u', "0401102031 3430"},
    {U'v', "042044"},
    {U'w', "0410233044"},
    {U'x', "0034 0430"},
    {U'y', "0420 441b"},
    {U'z', "04340030"},
    {U' ', ""},
    {U'.', "0000"},
    {U',', "100a"},
    {U':', "0000 0303"},
    {U';', "0303 000a"},
    {U'-', "0333"},
    {U'_', "0a4a"},
    {U'+', "0343 2125"},
    {U'=', "0242 0444"},
    {U'%', "0046 0506161505 3031414030"},
    {U'(', "16050110"},
    {U')', "06151100"},
    {U'[', "16060010"},
    {U']', "06161000"},
    {U'/', "0036"},
    {U'|', "060a"},
    {U'<', "450341"},
    {U'>', "054301"},
    {U'!', "0602 0000"},
    {U'?', "05163645442322 2020"},
    {U'\'', "0604"},
    {U'"', "0604 1614"},
    {U'#', "1016 3036 0242 0444"},
    {U'&', "4004051625240201102042"},
    {U'*', "0135 0531 0333"},
    {U'\u00b0', "0516251405"},               // degree
    {U'\u00b2', "0516250323"},               // superscript two
    {U'\u00b7', "0303"},                     // middle dot
    {U'\u00d7', "0145 0541"},                // times
    {U'\u03b8', "100105163645413010 0343"},  // theta
    {U'\u03c6', "100103143443413010 2b25"},  // phi
};
constexpr Glyph kUnknown = {0, "0006464000"};

constexpr double kCapital = 0.72 / 6;  // grid step, in sizes
constexpr double kGap = 1.7, kSpace = 3.6;

const Glyph& Find(char32_t code) {
  const auto* found =
      std::find_if(std::begin(kGlyphs), std::end(kGlyphs), [&](const Glyph& g) { return g.code == code; });
  return found == std::end(kGlyphs) ? kUnknown : *found;
}

/// UTF-8 to code points; a byte that belongs to none becomes U+FFFD.
std::vector<char32_t> Decode(const std::string& text) {
  std::vector<char32_t> codes;
  for (size_t i = 0; i < text.size();) {
    const uint8_t lead = static_cast<uint8_t>(text[i++]);
    const int more = lead < 0x80 ? 0 : lead >> 5 == 6 ? 1 : lead >> 4 == 14 ? 2 : lead >> 3 == 30 ? 3 : -1;
    char32_t code = more <= 0 ? lead : lead & (0x3f >> more);
    bool valid = more >= 0;
    for (int k = 0; k < more && valid; ++k) {
      valid = i < text.size() && (static_cast<uint8_t>(text[i]) & 0xc0) == 0x80;
      if (valid) code = code << 6 | (static_cast<uint8_t>(text[i++]) & 0x3f);
    }
    codes.push_back(valid ? code : U'\ufffd');
  }
  return codes;
}

double Height(char y) { return y == 'a' ? -1 : y == 'b' ? -2 : y - '0'; }

}  // namespace

std::vector<std::vector<Eigen::Vector2d>> StrokeText(const std::string& text, double size) {
  const double step = kCapital * size;
  std::vector<std::vector<Eigen::Vector2d>> strokes;
  double pen = 0;
  for (const char32_t code : Decode(text)) {
    double width = code == U' ' ? kSpace - kGap : 0;
    bool down = false;
    for (const char* p = Find(code).strokes; *p; ++p) {
      if (*p == ' ') {
        down = false;
        continue;
      }
      if (!down) strokes.emplace_back();
      down = true;
      const double x = *p - '0', y = Height(*++p);
      width = std::max(width, x);
      strokes.back().emplace_back((pen + x) * step, -y * step);
    }
    pen += width + kGap;
  }
  return strokes;
}

double StrokeTextWidth(const std::string& text, double size) {
  double pen = 0;
  for (const char32_t code : Decode(text)) {
    double width = code == U' ' ? kSpace - kGap : 0;
    for (const char* p = Find(code).strokes; *p; ++p) {
      if (*p != ' ') width = std::max(width, double(*p++ - '0'));
    }
    pen += width + kGap;
  }
  return std::max(0.0, pen - kGap) * kCapital * size;
}

}  // namespace lobe
