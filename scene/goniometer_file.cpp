#include "scene/goniometer_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/gltf_json.h"
#include "scene/input_error.h"
#include "scene/read_file.h"

namespace lobe {
namespace {

// Escaped and shortened as JSON strings are in messages, for what is no text at all.
std::string Printable(std::string_view text) {
  const std::string shown = Shown(nlohmann::json(std::string(text)));
  return shown.substr(1, shown.size() - (shown.ends_with('"') ? 2 : 1));
}

constexpr const char* kColumns = "theta_i, theta_o, dphi and f_r, or red, green, blue";
constexpr size_t kMostBytes = size_t{1} << 28;
constexpr size_t kMostPoints = size_t{1} << 24;  // chosen: 200 MB in memory

struct Row {
  size_t line;
  std::array<double, 3> angles;  // degrees
  std::array<double, 3> values;
};

std::vector<std::string_view> Fields(std::string_view line) {
  constexpr std::string_view kBetween = " \t\r,;";
  std::vector<std::string_view> fields;
  for (size_t at = line.find_first_not_of(kBetween); at != std::string_view::npos;) {
    const size_t end = std::min(line.find_first_of(kBetween, at), line.size());
    fields.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBetween, end);
  }
  return fields;
}

bool Number(std::string_view text, double* number) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto result = std::from_chars(text.data(), text.data() + text.size(), *number);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

class Table {
 public:
  explicit Table(const std::string& path) : path_(path) {}

  void Read() {
    const std::vector<uint8_t> bytes = ReadBytes(path_, kMostBytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    size_t line = 0;
    bool heading = true;  // the first line of words is one
    for (size_t at = 0; at < text.size(); ++line) {
      const size_t end = std::min(text.find('\n', at), text.size());
      std::string_view content = text.substr(at, end - at);
      content = content.substr(0, content.find('#'));
      at = end + 1;
      const auto fields = Fields(content);
      if (fields.empty()) continue;
      double number;
      if (std::exchange(heading, false) && !Number(fields[0], &number)) continue;
      ReadRow(line + 1, fields);
    }
    if (rows_.empty()) throw InputError(path_ + ": has no row, expected " + kColumns);
  }

  Measured Grid() {
    // The first row of each axis repeats until the axis before it moves on.
    size_t stride = 1;
    for (const int axis : {2, 1, 0}) {
      auto& angles = axes_[axis];
      for (size_t r = 0; r < rows_.size() && SameBefore(rows_[r], axis); r += stride) {
        const double angle = rows_[r].angles[axis];
        if (!angles.empty() && !(angle > angles.back())) break;  // Check tells what is wrong
        angles.push_back(angle);
      }
      stride *= angles.size();
    }
    Check();
    std::array<std::vector<float>, 3> radians;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double a : axes_[axis]) {
        const float angle = float(a * std::numbers::pi / 180);
        if (!radians[axis].empty() && !(angle > radians[axis].back())) {
          std::ostringstream what;
          what << path_ << ": two angles of about " << a
               << " degrees differ by less than single precision tells";
          throw InputError(what.str());
        }
        radians[axis].push_back(angle);
      }
    }
    std::vector<float> values;
    for (const Row& row : rows_) {
      for (const double v : row.values) values.push_back(float(v));
    }
    return {std::make_shared<const MeasuredBrdf>(MeasuredBrdf::FromAngles(
        std::filesystem::path(path_).filename().string(), radians[0], radians[1], radians[2], values))};
  }

 private:
  [[noreturn]] void Fail(size_t line, const std::string& sentence) const {
    throw InputError(path_ + ": line " + std::to_string(line) + ": " + sentence);
  }

  void ReadRow(size_t line, const std::vector<std::string_view>& fields) {
    if (columns_ == 0) columns_ = fields.size();
    if ((fields.size() != 4 && fields.size() != 6) || fields.size() != columns_) {
      Fail(line, "has " + std::to_string(fields.size()) + " numbers, expected " +
                     (columns_ == 4 || columns_ == 6 ? std::to_string(columns_) + " as before" : kColumns));
    }
    Row row{line, {}, {}};
    constexpr const char* kNames[3] = {"theta_i", "theta_o", "dphi"};
    constexpr double kMost[3] = {90, 90, 180};
    for (size_t i = 0; i < fields.size(); ++i) {
      double number = 0;
      if (!Number(fields[i], &number)) {
        Fail(line, std::string("'") + Printable(fields[i]) + "' found, expected a number");
      }
      const std::string shown(fields[i]);
      if (i < 3) {
        if (!(number >= 0 && number <= kMost[i])) {
          Fail(line, std::string(kNames[i]) + " is " + shown + ", expected 0 to " +
                         std::to_string(int(kMost[i])) + " degrees");
        }
        row.angles[i] = number;
      } else {
        if (!(number >= 0 && number <= MeasuredBrdf::kMostValue)) {
          Fail(line, "f_r is " + shown + ", expected 0 to 1e9 sr^-1");
        }
        row.values[i - 3] = number;
      }
    }
    if (columns_ == 4) row.values[1] = row.values[2] = row.values[0];
    rows_.push_back(row);
  }

  bool SameBefore(const Row& row, int axis) const {
    for (int a = 0; a < axis; ++a) {
      if (row.angles[a] != rows_[0].angles[a]) return false;
    }
    return true;
  }

  static std::string Words(const std::array<double, 3>& angles) {
    std::ostringstream out;
    out << "theta_i " << angles[0] << ", theta_o " << angles[1] << ", dphi " << angles[2];
    return out.str();
  }

  void Check() const {
    const size_t b = axes_[1].size(), c = axes_[2].size(), count = axes_[0].size() * b * c;
    const auto expected = [&](size_t r) {
      return std::array<double, 3>{axes_[0][r / (b * c)], axes_[1][r / c % b], axes_[2][r % c]};
    };
    for (size_t r = 0; r < rows_.size(); ++r) {
      if (r < count && rows_[r].angles == expected(r)) continue;
      Fail(rows_[r].line, Words(rows_[r].angles) + " found, expected " +
                              (r < count ? Words(expected(r)) : "larger angles than before") +
                              ": every theta_i has the same theta_o, each the same dphi, rising");
    }
    if (rows_.size() < count) {
      throw InputError(path_ + ": ends after line " + std::to_string(rows_.back().line) +
                       ", expected a row for " + Words(expected(rows_.size())));
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (axes_[axis].size() < 2) {
        throw InputError(path_ + ": has one angle " + std::array{"theta_i", "theta_o", "dphi"}[axis] +
                         ", expected at least 2");
      }
    }
    const size_t thetas = axes_[0].size() + b;  // at most that many in both together
    if (thetas * thetas > kMostPoints / c) {
      throw InputError(path_ + ": " + std::to_string(axes_[0].size()) + " x " + std::to_string(b) + " x " +
                       std::to_string(c) + " angles are too many, expected fewer than " +
                       std::to_string(kMostPoints) + " points with both directions exchanged");
    }
  }

  std::string path_;
  size_t columns_ = 0;
  std::vector<Row> rows_;
  std::array<std::vector<double>, 3> axes_;
};

}  // namespace

Measured ReadGoniometerFile(const std::string& path) {
  Table table(path);
  table.Read();
  return table.Grid();
}

}  // namespace lobe
