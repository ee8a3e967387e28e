#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace lobe {

/// The program's two voices. Standard output carries results: text, or with --json exactly one JSON
/// object. Standard error carries everything said along the way; --quiet silences that, save errors.
class Console {
 public:
  Console(bool json, bool quiet) : json_(json), quiet_(quiet) {}

  bool json() const { return json_; }
  bool quiet() const { return quiet_; }

  /// A line (or several) on standard error.
  void Say(const std::string& text) const;
  /// "warning: ..." on standard error.
  void Warn(const std::string& sentence) const;
  /// The result: `object` with --json, else `text`. Called once.
  void Result(const std::string& text, const nlohmann::json& object) const;

 private:
  bool json_, quiet_;
};

/// "lobe: ..." on standard error, even when quiet: the one line of a failure.
void PrintError(const std::string& sentence);

/// Columns of text, aligned.
class Table {
 public:
  /// A letter for each column: 'l' to the left, 'r' to the right.
  explicit Table(std::string alignment) : alignment_(std::move(alignment)) {}
  void AddRow(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// Lines indented by two spaces, each with a line end.
  std::string Text() const;

 private:
  std::string alignment_;
  std::vector<std::vector<std::string>> rows_;
};

/// `value` by a printf format for one double.
std::string Format(const char* format, double value);
/// Four significant digits; no negative zero.
std::string Short(double value);
/// "1.2 MB".
std::string Bytes(double bytes);
/// "8 s", "2 min 5 s", "1 h 20 min".
std::string Duration(double seconds);
/// "1 node", "2 nodes".
std::string Count(size_t n, const std::string& noun);

}  // namespace lobe
