#include "app/console.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lobe {
namespace {

/// Letters on the screen: UTF-8 continuation bytes take no room.
size_t Columns(const std::string& text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

void Print(FILE* stream, const std::string& text) {
  std::fputs(text.c_str(), stream);
  if (text.empty() || text.back() != '\n') std::fputc('\n', stream);
  std::fflush(stream);
}

}  // namespace

void Console::Say(const std::string& text) const {
  if (!quiet_) Print(stderr, text);
}

void Console::Warn(const std::string& sentence) const { Say("warning: " + sentence); }

void Console::Result(const std::string& text, const nlohmann::json& object) const {
  // Names from files may hold broken UTF-8; it is replaced rather than refused.
  Print(stdout, json_ ? object.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) : text);
}

void PrintError(const std::string& sentence) {
  std::string line = sentence;
  std::replace(line.begin(), line.end(), '\n', ' ');  // one failure, one line
  Print(stderr, "lobe: " + line);
}

std::string Table::Text() const {
  std::vector<size_t> widths(alignment_.size());
  for (const auto& row : rows_) {
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], Columns(row[i]));
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - Columns(row[i]), ' ');
      line.append("  ").append(alignment_[i] == 'l' ? row[i] + padding : padding + row[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text.append(line).append("\n");
  }
  return text;
}

std::string Format(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string Short(double value) { return Format("%.4g", value == 0 ? 0.0 : value); }

std::string Bytes(double bytes) {
  const char* units[] = {"bytes", "kB", "MB", "GB", "TB"};
  int unit = 0;
  for (; bytes >= 1000 && unit < 4; ++unit) bytes /= 1000;
  return Format(unit == 0 ? "%.0f" : "%.3g", bytes) + " " + units[unit];
}

std::string Duration(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::min(std::max(seconds, 0.0), 1e15)));
  const long long hours = whole / 3600, minutes = whole / 60 % 60;
  if (hours > 0) return std::to_string(hours) + " h " + std::to_string(minutes) + " min";
  if (minutes > 0) return std::to_string(minutes) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole) + " s";
}

std::string Count(size_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

}  // namespace lobe
