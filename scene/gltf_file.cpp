#include "scene/gltf_file.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>

#include <tiny_gltf.h>

#include "scene/gltf_accessor.h"
#include "scene/gltf_json.h"
#include "scene/input_error.h"
#include "scene/read_file.h"
#include "scene/uri.h"

namespace lobe {

namespace {

using Json = nlohmann::json;

using Bytes = std::span<const uint8_t>;

std::vector<uint8_t> ReadGltfBytes(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw InputError(path + ": is a directory, expected a glTF file");
  }
  return ReadBytes(path);
}

uint32_t Word(const uint8_t* p) {
  uint32_t word;
  std::memcpy(&word, p, sizeof word);
  return word;
}

constexpr uint32_t kGlbMagic = 0x46546C67;     // "glTF", glTF 2.0 section 4.4.2
constexpr uint32_t kJsonChunk = 0x4E4F534A;    // "JSON", section 4.4.3
constexpr uint32_t kBinaryChunk = 0x004E4942;  // "BIN"

/// Finds the JSON and binary chunks of a .glb; for a .gltf all of it is JSON.
void FindChunks(const std::string& path, const std::vector<uint8_t>& file, Bytes* json, Bytes* binary) {
  if (file.empty()) throw InputError(path + ": the file is empty");
  if (file.size() < 4 || Word(file.data()) != kGlbMagic) {
    const auto text = std::find_if_not(file.begin(), file.end(), [](uint8_t c) { return std::isspace(c); });
    const bool byte_order_mark = file[0] == 0xEF;
    if (text == file.end() || (*text != '{' && !byte_order_mark)) {
      throw InputError(path + ": begins with neither 'glTF' (.glb) nor '{' (.gltf): not a glTF 2.0 file");
    }
    *json = file;
    return;
  }
  if (file.size() < 20) {
    throw InputError(path + ": ends after " + std::to_string(file.size()) +
                     " bytes, within the .glb header: it is truncated");
  }
  if (Word(&file[4]) != 2) {
    throw InputError(path + ": .glb version is " + std::to_string(Word(&file[4])) + ", expected 2");
  }
  const size_t length = Word(&file[8]);
  if (length != file.size()) {
    throw InputError(path + ": declares " + std::to_string(length) + " bytes but has " +
                     std::to_string(file.size()) + (length > file.size() ? ": it is truncated" : ""));
  }
  for (size_t at = 12, chunk = 0; at < length; ++chunk) {
    if (length - at < 8 || Word(&file[at]) > length - at - 8) {
      throw InputError(path + ": chunk " + std::to_string(chunk) + " reaches beyond the end of the file");
    }
    const Bytes bytes(file.data() + at + 8, Word(&file[at]));
    const uint32_t type = Word(&file[at + 4]);
    if (chunk == 0 && type != kJsonChunk) throw InputError(path + ": its first chunk is not JSON");
    if (chunk == 0) *json = bytes;
    if (chunk == 1 && type == kBinaryChunk) *binary = bytes;
    at += 8 + bytes.size();  // chunks of other types are to be ignored
  }
}

/// Deepest nesting of brackets outside strings.
int Depth(Bytes json) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (size_t i = 0; i < json.size(); ++i) {
    const uint8_t c = json[i];
    if (in_string && c == '\\') {
      ++i;
    } else if (c == '"') {
      in_string = !in_string;
    } else if (!in_string) {
      if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
      if (c == ']' || c == '}') --depth;
    }
  }
  return deepest;
}

Json ParseJson(const std::string& path, Bytes text) {
  // Bounds the recursion of whoever walks the document; extras rarely nest beyond ten.
  constexpr int kDeepest = 256;
  if (Depth(text) > kDeepest) {
    throw InputError(path + ": its JSON is nested deeper than " + std::to_string(kDeepest));
  }
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const Json::parse_error& e) {
    throw InputError(path + ": its JSON is malformed at byte " + std::to_string(e.byte));
  } catch (const Json::exception&) {
    throw InputError(path + ": its JSON holds a number that is out of range");
  }
}

/// Has tinygltf fetch a buffer with a URI, given as a document of that buffer alone: tinygltf checks less
/// than we do, and stumbles over documents with mistakes elsewhere.
std::vector<uint8_t> FetchBuffer(const std::string& path, const GltfJson& buffer, const std::string& uri) {
  const std::string shown = uri.size() > 60 ? uri.substr(0, 60) + "..." : uri;
  const auto folder = std::filesystem::path(path).parent_path();
  const size_t declared = buffer.RequiredWhole("byteLength");
  size_t stored = 0;  // tinygltf insists on this, the specification lets there be more than declared
  if (uri.starts_with("data:")) {
    if (!tinygltf::IsDataURI(uri)) {
      buffer.Fail("its data URI '" + shown +
                  "' has an unknown media type, expected "
                  "application/octet-stream or application/gltf-buffer in base64");
    }
    const std::string base64 = uri.substr(uri.find(',') + 1);
    const size_t end = base64.find_last_not_of('=');
    const size_t digits = end == std::string::npos ? 0 : end + 1;
    stored = digits * 3 / 4;
  } else {
    if (uri.find("://") != std::string::npos) {
      buffer.Fail("its uri is '" + shown + "'; only files beside the scene and data URIs are read");
    }
    std::error_code error;
    const std::string file = FileOfUri(path, uri);
    if (!std::filesystem::is_regular_file(file, error)) {
      buffer.Fail("its file '" + shown + "' is missing");
    }
    stored = std::filesystem::file_size(file, error);
  }
  if (stored < declared) {
    buffer.Fail("'" + shown + "' holds " + std::to_string(stored) + " bytes, expected " +
                std::to_string(declared));
  }
  const Json alone = {{"asset", {{"version", "2.0"}}},
                      {"buffers", Json::array({{{"uri", uri}, {"byteLength", stored}}})}};
  const std::string text = alone.dump();
  if (text.size() > std::numeric_limits<unsigned>::max()) buffer.Fail("its data URI is too long");
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  const std::string base = folder.empty() ? "." : folder.string();
  if (!loader.LoadASCIIFromString(&model, &error, &warning, text.c_str(), static_cast<unsigned>(text.size()),
                                  base) ||
      model.buffers.size() != 1 || model.buffers[0].data.size() != stored) {
    buffer.Fail("'" + shown + "' cannot be read as " + std::to_string(declared) + " bytes");
  }
  return std::move(model.buffers[0].data);
}

}  // namespace

struct GltfFile::Impl {
  std::string path;
  std::vector<uint8_t> file;
  Json json;
  std::vector<std::vector<uint8_t>> fetched;  // buffers with a URI
  std::optional<GltfAccessors> accessors;
};

GltfFile::GltfFile(const std::string& path) : GltfFile(path, ReadGltfBytes(path)) {}

GltfFile::GltfFile(const std::string& path, std::vector<uint8_t> bytes) : impl_(std::make_unique<Impl>()) {
  Impl& g = *impl_;
  g.path = path;
  g.file = std::move(bytes);
  Bytes json, binary;
  FindChunks(path, g.file, &json, &binary);
  g.json = ParseJson(path, json);

  const GltfJson document(g.path, g.json);
  const std::string version = document.Object("asset").String("version");
  if (!version.starts_with("2.")) {
    document.Fail("asset.version is '" + version + "', expected '2.0'");
  }
  const size_t count = document.Count("buffers");
  std::vector<std::span<const uint8_t>> buffers(count);
  g.fetched.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const GltfJson buffer = document.Entry("buffers", i, "buffer");
    const size_t length = buffer.RequiredWhole("byteLength");
    if (buffer.Has("uri")) {
      g.fetched[i] = FetchBuffer(path, buffer, buffer.String("uri"));
      buffers[i] = std::span(g.fetched[i]).first(length);
    } else if (i == 0 && !binary.empty()) {
      if (length > binary.size()) {
        buffer.FailValue("byteLength",
                         "at most the " + std::to_string(binary.size()) + " of the binary chunk");
      }
      buffers[i] = binary.first(length);
    }
    // Else a placeholder, as compressed files have (EXT_meshopt_compression); an accessor that needs it
    // fails.
  }
  g.accessors.emplace(document, std::move(buffers));
}

GltfFile::~GltfFile() = default;
GltfFile::GltfFile(GltfFile&&) noexcept = default;

const std::string& GltfFile::path() const { return impl_->path; }
const nlohmann::json& GltfFile::json() const { return impl_->json; }

int GltfFile::AccessorCount(int accessor) const { return impl_->accessors->Count(accessor); }

std::vector<float> GltfFile::ReadFloats(int accessor, int components, const std::string& what) const {
  return impl_->accessors->ReadFloats(accessor, components, what);
}

std::vector<uint32_t> GltfFile::ReadIndices(int accessor, const std::string& what) const {
  return impl_->accessors->ReadIndices(accessor, what);
}

}  // namespace lobe
