#include "scene/gltf_json.h"

#include <cmath>
#include <sstream>

#include "scene/input_error.h"

namespace lobe {

namespace {

const nlohmann::json& EmptyObject() {
  static const nlohmann::json empty = nlohmann::json::object();
  return empty;
}

std::string Shown(double x) {
  std::ostringstream out;
  out << x;
  return out.str();
}

std::string Range(double min, double max) {
  if (std::isinf(min) && std::isinf(max)) return "a finite number";
  if (std::isinf(max)) return "a finite number of at least " + Shown(min);
  return Shown(min) + " to " + Shown(max);
}

bool IsNumberWithin(const nlohmann::json& value, double min, double max) {
  if (!value.is_number()) return false;
  const double x = value.get<double>();
  // A double beyond float's range would become infinite where it is used.
  return std::isfinite(static_cast<float>(x)) && x >= min && x <= max;
}

bool IsWholeWithin(const nlohmann::json& value, size_t max) {
  // Some writers print whole numbers as 3.0.
  if (value.is_number_unsigned()) return value.get<size_t>() <= max;
  if (!value.is_number_float()) return false;
  const double x = value.get<double>();
  return x >= 0 && x <= static_cast<double>(max) && x == std::floor(x);
}

}  // namespace

std::string Shown(const nlohmann::json& value) {
  constexpr size_t kLongest = 60;  // chosen: a sentence stays on a line or two
  std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

GltfJson::GltfJson(const std::string& file, const nlohmann::json& document)
    : value_(&document), file_(&file) {
  if (!document.is_object()) Fail("the document is " + Shown(document) + ", expected a JSON object");
}

void GltfJson::Fail(const std::string& sentence) const {
  throw InputError(*file_ + ": " + (element_.empty() ? "" : element_ + ": ") + sentence);
}

void GltfJson::FailValue(const char* key, const std::string& expected) const {
  const auto found = value_->find(key);
  Fail(prefix_ + key + (found == value_->end() ? " is missing" : " is " + Shown(*found)) + ", expected " +
       expected);
}

size_t GltfJson::Count(const char* array_key) const {
  const auto found = value_->find(array_key);
  if (found == value_->end()) return 0;
  if (!found->is_array()) FailValue(array_key, "an array");
  return found->size();
}

GltfJson GltfJson::Entry(const char* array_key, size_t index, const std::string& word) const {
  GltfJson entry;
  entry.value_ = &(*value_)[array_key][index];
  entry.file_ = file_;
  entry.element_ = (element_.empty() ? "" : element_ + ", ") + word + " " + std::to_string(index);
  if (!entry.value_->is_object()) entry.Fail("it is " + Shown(*entry.value_) + ", expected an object");
  const auto name = entry.value_->find("name");
  if (name != entry.value_->end() && name->is_string()) {
    entry.element_ += " '" + name->get_ref<const std::string&>() + "'";
  }
  return entry;
}

GltfJson GltfJson::Object(const char* key) const {
  GltfJson object = *this;
  const auto found = value_->find(key);
  if (found != value_->end() && !found->is_object()) FailValue(key, "an object");
  object.value_ = found == value_->end() ? &EmptyObject() : &*found;
  object.prefix_ = prefix_ + key + ".";
  return object;
}

GltfJson GltfJson::Extension(const char* name) const {
  GltfJson extension = Object("extensions").Object(name);
  extension.prefix_ = prefix_ + name + ".";
  return extension;
}

std::string GltfJson::String(const char* key, const std::string& missing) const {
  const auto found = value_->find(key);
  if (found == value_->end()) return missing;
  if (!found->is_string()) FailValue(key, "a string");
  return found->get<std::string>();
}

bool GltfJson::Bool(const char* key, bool missing) const {
  const auto found = value_->find(key);
  if (found == value_->end()) return missing;
  if (!found->is_boolean()) FailValue(key, "true or false");
  return found->get<bool>();
}

double GltfJson::Number(const char* key, double missing, double min, double max) const {
  const auto found = value_->find(key);
  if (found == value_->end()) return missing;
  if (!IsNumberWithin(*found, min, max)) FailValue(key, Range(min, max));
  return found->get<double>();
}

bool GltfJson::Numbers(const char* key, size_t count, double* numbers, double min, double max) const {
  const auto found = value_->find(key);
  if (found == value_->end()) return false;
  bool good = found->is_array() && found->size() == count;
  for (size_t i = 0; good && i < count; ++i) good = IsNumberWithin((*found)[i], min, max);
  if (!good) {
    FailValue(key, std::to_string(count) + " numbers, each " + Range(min, max));
  }
  for (size_t i = 0; i < count; ++i) numbers[i] = (*found)[i].get<double>();
  return true;
}

Rgb GltfJson::Color(const char* key, const Rgb& missing, double min, double max) const {
  double c[3];
  if (!Numbers(key, 3, c, min, max)) return missing;
  return Eigen::Array3d(c[0], c[1], c[2]).cast<float>();
}

size_t GltfJson::Whole(const char* key, size_t missing, size_t max) const {
  const auto found = value_->find(key);
  if (found == value_->end()) return missing;
  if (!IsWholeWithin(*found, max)) {
    FailValue(key, "a whole number" + (max == size_t{1} << 53 ? "" : " of at most " + std::to_string(max)));
  }
  return found->get<size_t>();
}

size_t GltfJson::RequiredWhole(const char* key, size_t max) const {
  if (!Has(key)) FailValue(key, "a whole number");
  return Whole(key, 0, max);
}

int GltfJson::Index(const char* key, size_t count) const {
  const auto found = value_->find(key);
  if (found == value_->end()) return -1;
  if (count == 0) FailValue(key, "none, since the file has nothing of that kind");
  if (!IsWholeWithin(*found, count - 1)) FailValue(key, "an index of at most " + std::to_string(count - 1));
  return found->get<int>();
}

std::vector<int> GltfJson::Indices(const char* key, size_t count) const {
  std::vector<int> indices;
  for (size_t i = 0; i < Count(key); ++i) {
    const nlohmann::json& index = (*value_)[key][i];
    if (count == 0 || !IsWholeWithin(index, count - 1)) {
      Fail(prefix_ + key + " contains " + Shown(index) + ", expected indices below " + std::to_string(count));
    }
    indices.push_back(index.get<int>());
  }
  return indices;
}

}  // namespace lobe
