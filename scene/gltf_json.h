#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "brdf/rgb.h"

namespace lobe {

/// An object somewhere in a glTF document, together with the words that lead there, so that a wrong value
/// is told as "room.glb: material 2 'oak': KHR_materials_ior.ior is 0.5, expected 0 or at least 1".
/// All getters throw InputError in that form. Borrows the document.
class GltfJson {
 public:
  /// The document itself. Throws InputError if it is not an object.
  GltfJson(const std::string& file, const nlohmann::json& document);

  bool Has(const char* key) const { return value_->contains(key); }
  const nlohmann::json& value() const { return *value_; }

  /// Number of entries of an optional array; 0 if it is missing.
  size_t Count(const char* array_key) const;
  /// Entry of an array of objects, called "`word` `index` 'its name'" from there on. `index` < Count.
  GltfJson Entry(const char* array_key, size_t index, const std::string& word) const;
  /// An optional object member; an empty object if it is missing.
  GltfJson Object(const char* key) const;
  /// The extension `name`, or an empty object.
  GltfJson Extension(const char* name) const;

  std::string String(const char* key, const std::string& missing = "") const;
  bool Bool(const char* key, bool missing) const;
  /// Finite as float and within [min, max].
  double Number(const char* key, double missing, double min = -std::numeric_limits<double>::infinity(),
                double max = std::numeric_limits<double>::infinity()) const;
  /// An array of `count` such numbers; false if the member is missing.
  bool Numbers(const char* key, size_t count, double* numbers,
               double min = -std::numeric_limits<double>::infinity(),
               double max = std::numeric_limits<double>::infinity()) const;
  /// Three numbers within [min, max].
  Rgb Color(const char* key, const Rgb& missing, double min = 0,
            double max = std::numeric_limits<double>::infinity()) const;
  /// A whole number within 0..max.
  size_t Whole(const char* key, size_t missing, size_t max = size_t{1} << 53) const;
  size_t RequiredWhole(const char* key, size_t max = size_t{1} << 53) const;
  /// An index into something that has `count` entries, or -1 if the member is missing.
  int Index(const char* key, size_t count) const;
  /// The same from an array of indices.
  std::vector<int> Indices(const char* key, size_t count) const;

  /// Throws InputError: "file: element: `sentence`".
  [[noreturn]] void Fail(const std::string& sentence) const;
  [[noreturn]] void FailValue(const char* key, const std::string& expected) const;
  /// "element" as messages call it, such as "material 2 'oak'".
  const std::string& element() const { return element_; }

 private:
  GltfJson() = default;
  const nlohmann::json* value_ = nullptr;
  const std::string* file_ = nullptr;
  std::string element_;  // "material 2 'oak'"
  std::string prefix_;   // "KHR_materials_ior."
};

/// A value as messages show it: JSON, cut off if long.
std::string Shown(const nlohmann::json& value);

}  // namespace lobe
