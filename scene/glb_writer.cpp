#include "scene/glb_writer.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include "scene/input_error.h"

namespace lobe {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian and written as it is");

namespace {

namespace fs = std::filesystem;
using Parts = std::vector<std::span<const uint8_t>>;

[[noreturn]] void FailToWrite(const std::string& path, int error) {
  throw InputError(path + ": cannot be written: " + std::strerror(error));
}

/// Where a write to `path` ends up: a symbolic link is kept and its target replaced.
fs::path Target(const std::string& path) {
  if (path.empty()) throw InputError("the name of an output file is empty");
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError(path + ": is a directory, expected the name of a file");
  if (fs::is_symlink(path, error)) {
    const fs::path target = fs::weakly_canonical(path, error);
    if (!error) return target;
  }
  return path;
}

/// Pipes and devices are written as they are: they must not be replaced by a file.
bool IsSpecial(const fs::path& target) {
  std::error_code error;
  const auto status = fs::status(target, error);
  return fs::exists(status) && !fs::is_regular_file(status);
}

fs::path Folder(const fs::path& target) {
  return target.parent_path().empty() ? fs::path(".") : target.parent_path();
}

/// A file under a passing name in the folder of `path`; gone with this object unless renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path) : path_(path), target_(Target(path)) {
    if (IsSpecial(target_)) {
      descriptor_ = open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
      // A short name of its own: the target's with an ending could be too long for the file system.
      for (int i = 0; i < 100 && descriptor_ < 0; ++i) {
        name_ = Folder(target_) / (".lobe-" + std::to_string(getpid()) + "-" + std::to_string(i) + ".tmp");
        descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ < 0 && errno != EEXIST) break;
      }
      if (descriptor_ < 0) {
        const int error = errno;
        name_.clear();
        FailToWrite(path_, error);
      }
    }
    if (descriptor_ < 0) FailToWrite(path_, errno);
  }

  ~TemporaryFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!name_.empty()) unlink(name_.c_str());
  }

  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void Write(const Parts& parts) {
    for (const auto& part : parts) {
      for (size_t done = 0; done < part.size();) {
        const ssize_t n = write(descriptor_, part.data() + done, part.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) FailToWrite(path_, errno);
        done += static_cast<size_t>(n);
      }
    }
    // Pipes and terminals have nothing to flush to.
    if (fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) FailToWrite(path_, errno);
    const int descriptor = std::exchange(descriptor_, -1);
    if (close(descriptor) != 0) FailToWrite(path_, errno);
  }

  void Rename() {
    if (name_.empty()) return;
    if (rename(name_.c_str(), target_.c_str()) != 0) FailToWrite(path_, errno);
    name_.clear();
    // The new name is safe once the folder is; some file systems cannot, and the file is whole anyway.
    const int folder = open(Folder(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
      fsync(folder);
      close(folder);
    }
  }

 private:
  std::string path_;
  fs::path target_, name_;
  int descriptor_ = -1;
};

std::span<const uint8_t> AsBytes(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

/// Characters that may not stand in a URI as they are become %XX, RFC 3986 section 2.
std::string PercentEncoded(const std::string& name) {
  std::string uri;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) || std::strchr("-._~", c)) {
      uri += c;
    } else {
      char code[4];
      std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned char>(c));
      uri += code;
    }
  }
  return uri;
}

}  // namespace

GlbWriter::GlbWriter() { document["asset"] = {{"version", "2.0"}, {"generator", "Lobe"}}; }

int GlbWriter::AddView(const void* data, size_t bytes, Target target) {
  if (bytes == 0) throw std::invalid_argument("GlbWriter: glTF has no empty accessors");
  buffer_.resize((buffer_.size() + 3) / 4 * 4);  // alignment of the largest component, section 3.6.2.4
  nlohmann::json view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}};
  if (target != Target::kNone) view["target"] = static_cast<int>(target);
  const auto* begin = static_cast<const uint8_t*>(data);
  buffer_.insert(buffer_.end(), begin, begin + bytes);
  document["bufferViews"].push_back(std::move(view));
  return static_cast<int>(document["bufferViews"].size() - 1);
}

int GlbWriter::AddFloats(std::span<const float> values, const std::string& type, Target target, bool bounds) {
  static const nlohmann::json kComponents = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  const size_t components = kComponents.at(type);
  if (values.size() % components != 0)
    throw std::invalid_argument("GlbWriter: not a whole number of " + type);
  const int view = AddView(values.data(), values.size_bytes(), target);
  nlohmann::json accessor = {
      {"bufferView", view}, {"componentType", 5126}, {"type", type}, {"count", values.size() / components}};
  if (bounds) {
    std::vector<float> min(components, std::numeric_limits<float>::infinity()), max(components, -min[0]);
    for (size_t i = 0; i < values.size(); ++i) {
      min[i % components] = std::min(min[i % components], values[i]);
      max[i % components] = std::max(max[i % components], values[i]);
    }
    accessor["min"] = min;
    accessor["max"] = max;
  }
  document["accessors"].push_back(std::move(accessor));
  return static_cast<int>(document["accessors"].size() - 1);
}

int GlbWriter::AddUnsigned(const void* data, size_t bytes, size_t count, int component_type, Target target) {
  const int view = AddView(data, bytes, target);
  document["accessors"].push_back(
      {{"bufferView", view}, {"componentType", component_type}, {"type", "SCALAR"}, {"count", count}});
  return static_cast<int>(document["accessors"].size() - 1);
}

int GlbWriter::AddUints(std::span<const uint32_t> values, Target target) {
  return AddUnsigned(values.data(), values.size_bytes(), values.size(), 5125, target);
}

int GlbWriter::AddBytes(std::span<const uint8_t> values) {
  return AddUnsigned(values.data(), values.size_bytes(), values.size(), 5121, Target::kNone);
}

int GlbWriter::AddShorts(std::span<const uint16_t> values) {
  return AddUnsigned(values.data(), values.size_bytes(), values.size(), 5123, Target::kNone);
}

namespace {

bool IsGltf(const std::string& path) { return fs::path(path).extension() == ".gltf"; }
fs::path BinaryBeside(const std::string& path) { return fs::path(path).replace_extension(".bin"); }

// The .bin beside a .gltf may be replaced only if that .gltf is there and its own: another file of the name
// is somebody else's data.
void CheckBinaryIsOurs(const std::string& path) {
  const fs::path binary = BinaryBeside(path);
  if (!IsGltf(path) || !fs::exists(binary)) return;
  std::ifstream file(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (text.find('"' + PercentEncoded(binary.filename().string()) + '"') != std::string::npos) return;
  throw InputError(binary.string() + ": exists and does not belong to " + path +
                   ", which would overwrite it; choose another name, or one ending in .glb");
}

// Names from elsewhere may be no UTF-8; the file has to be.
std::string Dump(const nlohmann::json& document, int indent) {
  return document.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<uint8_t> Words(std::initializer_list<size_t> words) {
  std::vector<uint8_t> bytes;
  for (const size_t word : words) {
    const auto value = static_cast<uint32_t>(word);
    const auto* begin = reinterpret_cast<const uint8_t*>(&value);
    bytes.insert(bytes.end(), begin, begin + sizeof value);
  }
  return bytes;
}

/// What stands in a .glb before the bytes of its buffer: headers and JSON.
std::vector<uint8_t> GlbHead(const nlohmann::json& document, size_t buffer_bytes, const std::string& name,
                             const std::string& advice) {
  std::string text = Dump(document, -1);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const size_t length = 12 + 8 + text.size() + (buffer_bytes == 0 ? 0 : 8 + buffer_bytes);
  if (length > std::numeric_limits<uint32_t>::max()) {
    throw InputError(name + ": would have " + std::to_string(length) +
                     " bytes, expected less than 4 GiB in a .glb" + advice);
  }
  std::vector<uint8_t> head = Words({0x46546C67, 2, length, text.size(), 0x4E4F534A});
  head.insert(head.end(), text.begin(), text.end());
  if (buffer_bytes > 0) {
    const std::vector<uint8_t> chunk = Words({buffer_bytes, 0x004E4942});
    head.insert(head.end(), chunk.begin(), chunk.end());
  }
  return head;
}

}  // namespace

nlohmann::json GlbWriter::WithBuffer(const std::string& uri) const {
  nlohmann::json out = document;
  if (buffer_.empty()) return out;
  nlohmann::json buffer = {{"byteLength", PaddedBytes()}};
  if (!uri.empty()) buffer["uri"] = uri;
  out["buffers"] = nlohmann::json::array({buffer});
  return out;
}

void GlbWriter::Write(const std::string& path) {
  CheckBinaryIsOurs(path);
  buffer_.resize(PaddedBytes());
  if (IsGltf(path)) {
    const std::string binary_path = BinaryBeside(path).string();
    const std::string text = Dump(WithBuffer(PercentEncoded(fs::path(binary_path).filename().string())), 1);
    TemporaryFile json(path);
    json.Write({AsBytes(text)});
    if (!buffer_.empty()) {
      TemporaryFile binary(binary_path);
      binary.Write({buffer_});
      binary.Rename();
    }
    json.Rename();
    return;
  }
  const std::vector<uint8_t> head =
      GlbHead(WithBuffer(), buffer_.size(), path, "; choose a name ending in .gltf");
  TemporaryFile file(path);
  file.Write(buffer_.empty() ? Parts{head} : Parts{head, buffer_});
  file.Rename();
}

std::vector<uint8_t> GlbWriter::Glb(const std::string& name) const {
  std::vector<uint8_t> bytes = GlbHead(WithBuffer(), PaddedBytes(), name, "");
  const size_t whole = bytes.size() + PaddedBytes();
  bytes.reserve(whole);
  bytes.insert(bytes.end(), buffer_.begin(), buffer_.end());
  bytes.resize(whole);
  return bytes;
}

void WriteFileAtomically(const std::string& path, std::span<const uint8_t> bytes) {
  TemporaryFile file(path);
  file.Write({bytes});
  file.Rename();
}

void CheckWritable(const std::string& path) {
  CheckBinaryIsOurs(path);
  const fs::path target = Target(path);
  if (IsSpecial(target)) {  // opening a pipe would wait for its reader
    if (access(target.c_str(), W_OK) != 0) FailToWrite(path, errno);
    return;
  }
  // Trying is the only honest test: permissions say nothing about read-only file systems.
  const TemporaryFile attempt(path);
}

}  // namespace lobe
