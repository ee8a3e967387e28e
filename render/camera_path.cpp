#include "render/camera_path.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "scene/input_error.h"

namespace lobe {
namespace {

using Json = nlohmann::json;

/// Of a spline at key `i`. `value(i)` is an Eigen array or a double; `same(i)`: keys i and i + 1 are equal.
template <typename Value>
auto Derivative(const std::vector<CameraKey>& keys, size_t i, const Value& value) {
  using V = decltype(value(keys[0]));
  const size_t last = keys.size() - 1;
  const auto step = [&](size_t k) { return keys[k + 1].time - keys[k].time; };
  const auto slope = [&](size_t k) { return V((value(keys[k + 1]) - value(keys[k])) / step(k)); };
  const auto halt = [&](size_t k) { return V(value(keys[k + 1]) - value(keys[k])).isZero(0); };
  if ((i > 0 && halt(i - 1)) || (i < last && halt(i))) return V(V::Zero());
  if (last == 1) return slope(0);
  if (i == 0) {
    const double h0 = step(0), h1 = step(1);
    return V(((2 * h0 + h1) * slope(0) - h0 * slope(1)) / (h0 + h1));
  }
  if (i == last) {
    const double h0 = step(last - 1), h1 = step(last - 2);
    return V(((2 * h0 + h1) * slope(last - 1) - h0 * slope(last - 2)) / (h0 + h1));
  }
  const double before = step(i - 1), after = step(i);
  return V((after * slope(i - 1) + before * slope(i)) / (before + after));
}

/// Between keys i and i + 1, at the fraction u.
template <typename Value>
auto Spline(const std::vector<CameraKey>& keys, size_t i, double u, const Value& value) {
  using V = decltype(value(keys[0]));
  const double h = keys[i + 1].time - keys[i].time, u2 = u * u, u3 = u2 * u;
  const V a = value(keys[i]), b = value(keys[i + 1]);
  const V da = Derivative(keys, i, value), db = Derivative(keys, i + 1, value);
  return V((2 * u3 - 3 * u2 + 1) * a + (u3 - 2 * u2 + u) * h * da + (3 * u2 - 2 * u3) * b +
           (u3 - u2) * h * db);
}

using Scalar = Eigen::Array<double, 1, 1>;

std::string Number(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

/// A value found where another was expected, in few words. Lists within lists are not looked into: printing
/// them recurses as deep as they go.
std::string Found(const Json& value) {
  const auto structured = [](const Json& v) { return v.is_structured(); };
  if (value.is_structured() && std::any_of(value.begin(), value.end(), structured)) {
    return std::string("nested ") + value.type_name() + "s";
  }
  constexpr size_t kLongest = 60;
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

/// A keyframe's members, with words for what is wrong with them.
class KeyReader {
 public:
  KeyReader(const std::string& path, size_t index, const Json& json)
      : where_(path + ": keyframe " + std::to_string(index)), json_(json) {
    if (!json.is_object()) Fail("is " + std::string(json.type_name()) + "; an object is expected");
    static const std::set<std::string> kKnown = {"frame", "time", "eye", "target", "up", "fov"};
    for (const auto& [name, value] : json.items()) {
      if (!kKnown.count(name)) {
        Fail("has the unknown member '" + name + "'; frame, time, eye, target, up and fov are expected");
      }
    }
  }

  bool Has(const char* name) const { return json_.contains(name); }

  double Real(const char* name) const {
    if (!Has(name)) Fail(std::string("has no '") + name + "', which is expected");
    const Json& value = json_[name];
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      Fail(std::string("'") + name + "' is " + Found(value) + "; a number is expected");
    }
    return value.get<double>();
  }

  Vec3 Vector(const char* name) const {
    if (!Has(name)) Fail(std::string("has no '") + name + "', which is expected");
    const Json& value = json_[name];
    Vec3 v = Vec3::Zero();
    bool good = value.is_array() && value.size() == 3;
    for (int c = 0; good && c < 3; ++c) {
      good = value[c].is_number() && std::isfinite(value[c].get<float>());
      if (good) v[c] = value[c].get<float>();
    }
    if (!good) {
      Fail(std::string("'") + name + "' is " + Found(value) + "; three numbers are expected");
    }
    return v;
  }

  [[noreturn]] void Fail(const std::string& words) const { throw InputError(where_ + " " + words); }

 private:
  std::string where_;
  const Json& json_;
};

CameraKey ReadKey(const KeyReader& reader, const char* clock) {
  CameraKey key;
  key.time = reader.Real(clock);
  if (clock == std::string("frame") &&
      !(key.time == std::round(key.time) && key.time >= 0 && key.time <= 1e9)) {
    reader.Fail("'frame' is " + Number(key.time) + "; a whole number from 0 is expected");
  }
  key.eye = reader.Vector("eye");
  key.target = reader.Vector("target");
  if (reader.Has("up")) key.up = reader.Vector("up");
  if (reader.Has("fov")) key.fov_y_degrees = reader.Real("fov");
  return key;
}

Camera ViewFrom(const Vec3& eye, const Vec3& target, const Vec3& up, double fov_y_degrees) {
  return LookAt(eye, target, up, float(fov_y_degrees * std::numbers::pi / 180));
}

}  // namespace

CameraPath::CameraPath(std::vector<CameraKey> keys, bool in_frames)
    : keys_(std::move(keys)), in_frames_(in_frames) {
  if (keys_.size() < 2) {
    throw InputError("there is " + std::string(keys_.empty() ? "no keyframe" : "one keyframe") +
                     "; two or more are expected");
  }
  for (size_t i = 0; i < keys_.size(); ++i) {
    CameraKey& key = keys_[i];
    const std::string name = "keyframe " + std::to_string(i);
    if (i > 0 && !(key.time > keys_[i - 1].time)) {
      throw InputError(name + " is at " + Number(key.time) + ", after one at " + Number(keys_[i - 1].time) +
                       "; rising times are expected");
    }
    try {
      ViewFrom(key.eye, key.target, key.up, key.fov_y_degrees);
    } catch (const InputError& e) {
      throw InputError(name + ": " + e.what());
    }
    key.up.normalize();  // so that long ones do not outweigh short ones between them
  }
}

Camera CameraPath::At(double time) const {
  const auto after = std::upper_bound(keys_.begin() + 1, keys_.end() - 1, time,
                                      [](double t, const CameraKey& key) { return t < key.time; });
  const size_t i = size_t(after - keys_.begin()) - 1;
  const CameraKey &a = keys_[i], &b = keys_[i + 1];
  const double u = std::clamp((time - a.time) / (b.time - a.time), 0.0, 1.0);

  using Array = Eigen::Array3d;
  const Array eye = Spline(keys_, i, u, [](const CameraKey& k) { return Array(k.eye.cast<double>()); });
  const Array target = Spline(keys_, i, u, [](const CameraKey& k) { return Array(k.target.cast<double>()); });
  const Array up = Spline(keys_, i, u, [](const CameraKey& k) { return Array(k.up.cast<double>()); });
  const double fov = Spline(keys_, i, u, [](const CameraKey& k) { return Scalar(k.fov_y_degrees); })(0);
  const auto [low, high] = std::minmax(a.fov_y_degrees, b.fov_y_degrees);
  try {
    return ViewFrom(eye.matrix().cast<float>(), target.matrix().cast<float>(), up.matrix().cast<float>(),
                    std::clamp(fov, low, high));
  } catch (const InputError& e) {
    throw InputError("between keyframes " + std::to_string(i) + " and " + std::to_string(i + 1) + ", at " +
                     Number(time) + ": " + e.what());
  }
}

std::vector<PathFrame> CameraPath::Frames(std::optional<int> count) const {
  const double first = keys_.front().time, last = keys_.back().time;
  if (!count && !in_frames_) throw InputError("times are no frame numbers; a count of frames is expected");
  const double wanted = count ? *count : last - first + 1;
  if (wanted < 1 || wanted > kMaxFrames) {
    throw InputError(Number(wanted) + " frames; 1 to " + std::to_string(kMaxFrames) + " are expected");
  }
  std::vector<PathFrame> frames;
  for (int i = 0; i < int(wanted); ++i) {
    if (count) {
      frames.push_back({i, *count == 1 ? first : first + (last - first) * i / (*count - 1)});
    } else {
      frames.push_back({int(first) + i, first + i});
    }
  }
  return frames;
}

CameraPath ReadCameraPath(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw InputError(path + ": is a directory; a camera path is expected");
  }
  std::ifstream file(path, std::ios::binary);
  constexpr size_t kLargest = size_t(1) << 24;  // 100,000 keys; what never ends is refused too
  std::string text(kLargest + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  if (text.size() > kLargest) {
    throw InputError(path + ": has more than 16 MB; a camera path has less");
  }
  if (file.bad() || (text.empty() && !file.is_open()))
    throw InputError(path + ": cannot be read; a camera path is expected");
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& e) {
    throw InputError(path + ": not readable as JSON (" + e.what() + ")");
  }
  if (!json.is_object() || !json.contains("keyframes") || !json["keyframes"].is_array()) {
    throw InputError(path + ": has no array 'keyframes'; an object with one is expected");
  }
  for (const auto& [name, value] : json.items()) {
    if (name != "keyframes") {
      throw InputError(path + ": has the unknown member '" + name + "'; 'keyframes' alone is expected");
    }
  }
  const Json& list = json["keyframes"];
  std::vector<CameraKey> keys;
  const char* clock = "frame";
  for (size_t i = 0; i < list.size(); ++i) {
    const KeyReader reader(path, i, list[i]);
    if (reader.Has("frame") == reader.Has("time")) {
      reader.Fail(reader.Has("frame") ? "has both 'frame' and 'time'; one of them is expected"
                                      : "has neither 'frame' nor 'time'; one of them is expected");
    }
    if (i == 0 && reader.Has("time")) clock = "time";
    if (!reader.Has(clock)) {
      reader.Fail(std::string("has no '") + clock + "', which the first has; the same is expected of all");
    }
    keys.push_back(ReadKey(reader, clock));
  }
  try {
    return CameraPath(std::move(keys), clock == std::string("frame"));
  } catch (const InputError& e) {
    throw InputError(path + ": " + e.what());
  }
}

}  // namespace lobe
