#include "scene/gltf_file.h"

#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>

#include <tiny_gltf.h>

#include "scene/gltf_json.h"
#include "scene/input_error.h"

namespace lobe {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian and read in place");

namespace {

using Json = nlohmann::json;

struct Bytes {
  const uint8_t* data = nullptr;
  size_t size = 0;
};

std::vector<uint8_t> ReadWholeFile(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path + ": no such file");
  if (std::filesystem::is_directory(status)) throw InputError(path + ": is a directory, expected a glTF file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path + ": is not a regular file");
  std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw InputError(path + ": cannot be read: " + std::strerror(errno));
  std::vector<uint8_t> bytes(std::filesystem::file_size(path, error));
  if (error || std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) {
    throw InputError(path + ": cannot be read to its end");
  }
  return bytes;
}

uint32_t Word(const uint8_t* p) {
  uint32_t word;
  std::memcpy(&word, p, sizeof word);
  return word;
}

constexpr uint32_t kGlbMagic = 0x46546C67;    // "glTF", glTF 2.0 section 4.4.2
constexpr uint32_t kJsonChunk = 0x4E4F534A;   // "JSON", section 4.4.3
constexpr uint32_t kBinaryChunk = 0x004E4942; // "BIN"

/// Finds the JSON and binary chunks of a .glb; for a .gltf all of it is JSON.
void FindChunks(const std::string& path, const std::vector<uint8_t>& file, Bytes* json, Bytes* binary) {
  if (file.empty()) throw InputError(path + ": the file is empty");
  if (file.size() < 4 || Word(file.data()) != kGlbMagic) {
    const auto text = std::find_if_not(file.begin(), file.end(), [](uint8_t c) { return std::isspace(c); });
    const bool byte_order_mark = file[0] == 0xEF;
    if (text == file.end() || (*text != '{' && !byte_order_mark)) {
      throw InputError(path + ": begins with neither 'glTF' (.glb) nor '{' (.gltf): not a glTF 2.0 file");
    }
    *json = {file.data(), file.size()};
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
    const Bytes bytes = {&file[at] + 8, Word(&file[at])};
    const uint32_t type = Word(&file[at + 4]);
    if (chunk == 0 && type != kJsonChunk) throw InputError(path + ": its first chunk is not JSON");
    if (chunk == 0) *json = bytes;
    if (chunk == 1 && type == kBinaryChunk) *binary = bytes;
    at += 8 + bytes.size;   // chunks of other types are to be ignored
  }
}

Json ParseJson(const std::string& path, const Bytes& text) {
  // Bounds the recursion of whoever walks the document; extras rarely nest beyond ten.
  constexpr int kDeepest = 256;
  const auto check_depth = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest) throw InputError(path + ": its JSON is nested deeper than " + std::to_string(kDeepest));
    return true;
  };
  try {
    return Json::parse(text.data, text.data + text.size, check_depth);
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
  size_t stored = 0;   // tinygltf insists on this, the specification lets there be more than declared
  if (uri.starts_with("data:")) {
    if (!tinygltf::IsDataURI(uri)) {
      buffer.Fail("its data URI '" + shown + "' has an unknown media type, expected "
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
    std::string decoded;
    for (size_t i = 0; i < uri.size(); ++i) {   // percent-encoding, RFC 3986 section 2.1
      int byte = 0;
      if (uri[i] == '%' && i + 2 < uri.size() && std::sscanf(uri.substr(i + 1, 2).c_str(), "%2x", &byte) == 1) {
        decoded += static_cast<char>(byte);
        i += 2;
      } else {
        decoded += uri[i];
      }
    }
    std::error_code error;
    const auto file = folder / decoded;
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

int ComponentBytes(size_t component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
    default: return 0;
  }
}

int Components(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  if (type == "MAT4") return 16;
  return 0;   // MAT2 and MAT3 have padded columns, and nothing we read has such type
}

/// Calls use(typed pointer maker, normalisation factor) for the component type at hand.
template <typename Use>
void WithComponentType(size_t component_type, const Use& use) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return use(int8_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return use(uint8_t{});
    case TINYGLTF_COMPONENT_TYPE_SHORT: return use(int16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return use(uint16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return use(uint32_t{});
    default: return use(float{});
  }
}

/// Elements laid out in a buffer view, known to lie inside it.
struct Elements {
  const uint8_t* data = nullptr;
  size_t stride = 0;
  size_t count = 0;
};

/// To[count * components] from elements of component type From. Integers are scaled by glTF 2.0
/// section 3.11's f = max(c / largest, -1) if `normalized`.
template <typename From, typename To>
void Convert(const Elements& from, int components, bool normalized, To* to) {
  if (std::is_same_v<From, To> && from.stride == components * sizeof(From)) {
    std::memcpy(to, from.data, from.count * from.stride);
    return;
  }
  for (size_t i = 0; i < from.count; ++i) {
    const uint8_t* element = from.data + i * from.stride;
    for (int k = 0; k < components; ++k) {
      From value;
      std::memcpy(&value, element + k * sizeof(From), sizeof(From));
      if constexpr (std::is_integral_v<From> && std::is_floating_point_v<To>) {
        if (normalized) {
          constexpr To kLargest = static_cast<To>(std::numeric_limits<From>::max());
          *to++ = std::max(static_cast<To>(value) / kLargest, To{-1});
          continue;
        }
      }
      *to++ = static_cast<To>(value);
    }
  }
}

}  // namespace

struct GltfFile::Impl {
  std::string path;
  std::vector<uint8_t> file;
  Json json;
  std::vector<std::vector<uint8_t>> fetched;   // buffers with a URI
  std::vector<Bytes> buffers;

  GltfJson document() const { return GltfJson(path, json); }

  [[noreturn]] void Fail(int accessor, const std::string& what, const std::string& sentence) const {
    throw InputError(path + ": " + what + ": accessor " + std::to_string(accessor) + " " + sentence);
  }

  GltfJson Accessor(int accessor, const std::string& what) const {
    const size_t count = document().Count("accessors");
    if (accessor < 0 || static_cast<size_t>(accessor) >= count) {
      Fail(accessor, what, "does not exist; the file has " + std::to_string(count));
    }
    return document().Entry("accessors", accessor, what + ": accessor");
  }

  /// `owner` (an accessor or a part of its sparse override) has bufferView and byteOffset.
  Elements Locate(const GltfJson& owner, size_t count, size_t element_bytes, bool may_stride) const {
    const int view_index = owner.Index("bufferView", document().Count("bufferViews"));
    if (view_index < 0) owner.FailValue("bufferView", "an index");
    const GltfJson view = document().Entry("bufferViews", view_index, owner.element() + ": bufferView");
    const int buffer = view.Index("buffer", buffers.size());
    if (buffer < 0) view.FailValue("buffer", "an index");
    const size_t view_offset = view.Whole("byteOffset", 0);
    const size_t view_length = view.RequiredWhole("byteLength");
    if (view_offset + view_length > buffers[buffer].size) {
      view.Fail("it spans bytes " + std::to_string(view_offset) + " to " +
                std::to_string(view_offset + view_length) + ", but buffer " + std::to_string(buffer) + " has " +
                std::to_string(buffers[buffer].size));
    }
    Elements elements;
    elements.count = count;
    elements.stride = may_stride ? view.Whole("byteStride", element_bytes, 1 << 16) : element_bytes;
    if (elements.stride < element_bytes) {
      view.FailValue("byteStride", "at least " + std::to_string(element_bytes) + ", the size of an element");
    }
    const size_t offset = owner.Whole("byteOffset", 0);
    // count is at most 2^32 and the stride 2^16: no overflow.
    const size_t end = offset + (count - 1) * elements.stride + element_bytes;
    if (end > view_length) {
      owner.Fail(std::to_string(count) + " elements end at byte " + std::to_string(end) + " of bufferView " +
                 std::to_string(view_index) + ", which has " + std::to_string(view_length));
    }
    elements.data = buffers[buffer].data + view_offset + offset;
    return elements;
  }

  template <typename To>
  std::vector<To> Read(const GltfJson& accessor, int components) const {
    constexpr size_t kMostElements = size_t{1} << 32;
    const size_t component_type = accessor.RequiredWhole("componentType");
    const size_t element_bytes = static_cast<size_t>(components) * ComponentBytes(component_type);
    const size_t count = accessor.RequiredWhole("count", kMostElements);
    if (count == 0) accessor.FailValue("count", "at least 1");
    const bool normalized = accessor.Bool("normalized", false);

    std::vector<To> values;
    if (accessor.Has("bufferView")) {
      const Elements elements = Locate(accessor, count, element_bytes, true);
      values.resize(count * components);
      WithComponentType(component_type, [&](auto from) {
        Convert<decltype(from)>(elements, components, normalized, values.data());
      });
    } else {
      // All zeros, with no data in the file that would bound the count.
      constexpr size_t kMostZeros = size_t{1} << 24;   // chosen: 200 MB of VEC3
      if (count > kMostZeros) {
        accessor.FailValue("count", "at most " + std::to_string(kMostZeros) + " without a bufferView");
      }
      values.resize(count * components);
    }
    if (accessor.Has("sparse")) Override(accessor.Object("sparse"), component_type, components, normalized, &values);
    return values;
  }

  template <typename To>
  void Override(const GltfJson& sparse, size_t component_type, int components, bool normalized,
                std::vector<To>* values) const {
    const size_t total = values->size() / components;
    const size_t count = sparse.RequiredWhole("count", total);
    if (count == 0) return;
    const GltfJson where = sparse.Object("indices");
    const size_t index_type = where.RequiredWhole("componentType");
    if (index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
      where.FailValue("componentType", "5121, 5123 or 5125");
    }
    const Elements index_elements = Locate(where, count, ComponentBytes(index_type), false);
    const Elements value_elements =
        Locate(sparse.Object("values"), count, static_cast<size_t>(components) * ComponentBytes(component_type), false);
    std::vector<uint32_t> indices(count);
    WithComponentType(index_type, [&](auto from) {
      Convert<decltype(from)>(index_elements, 1, false, indices.data());
    });
    std::vector<To> replacements(count * components);
    WithComponentType(component_type, [&](auto from) {
      Convert<decltype(from)>(value_elements, components, normalized, replacements.data());
    });
    for (size_t i = 0; i < count; ++i) {
      if (indices[i] >= total) {
        sparse.Fail("sparse index " + std::to_string(i) + " is " + std::to_string(indices[i]) +
                    ", expected below " + std::to_string(total));
      }
      std::copy_n(&replacements[i * components], components, &(*values)[size_t{indices[i]} * components]);
    }
  }
};

GltfFile::GltfFile(const std::string& path) : impl_(std::make_unique<Impl>()) {
  Impl& g = *impl_;
  g.path = path;
  g.file = ReadWholeFile(path);
  Bytes json, binary;
  FindChunks(path, g.file, &json, &binary);
  g.json = ParseJson(path, json);

  const GltfJson document = g.document();
  const std::string version = document.Object("asset").String("version");
  if (!version.starts_with("2.")) {
    document.Fail("asset.version is '" + version + "', expected '2.0'");
  }
  const size_t count = document.Count("buffers");
  g.fetched.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const GltfJson buffer = document.Entry("buffers", i, "buffer");
    const size_t length = buffer.RequiredWhole("byteLength");
    if (buffer.Has("uri")) {
      g.fetched.push_back(FetchBuffer(path, buffer, buffer.String("uri")));
      g.buffers.push_back({g.fetched.back().data(), length});
    } else if (i == 0 && binary.data) {
      if (length > binary.size) {
        buffer.FailValue("byteLength", "at most the " + std::to_string(binary.size) + " of the binary chunk");
      }
      g.buffers.push_back({binary.data, length});
    } else {
      // Compressed data may leave a placeholder (EXT_meshopt_compression); an accessor that needs it fails.
      g.buffers.push_back({nullptr, 0});
    }
  }
}

GltfFile::~GltfFile() = default;
GltfFile::GltfFile(GltfFile&&) noexcept = default;

const std::string& GltfFile::path() const { return impl_->path; }
const nlohmann::json& GltfFile::json() const { return impl_->json; }

int GltfFile::AccessorCount(int accessor) const {
  return static_cast<int>(impl_->Accessor(accessor, "document").RequiredWhole("count", std::numeric_limits<int>::max()));
}

std::vector<float> GltfFile::ReadFloats(int accessor, int components, const std::string& what) const {
  const GltfJson json = impl_->Accessor(accessor, what);
  if (Components(json.String("type")) != components) {
    json.FailValue("type", components == 1 ? "SCALAR" : components == 16 ? "MAT4" : "VEC" + std::to_string(components));
  }
  if (ComponentBytes(json.RequiredWhole("componentType")) == 0) {
    json.FailValue("componentType", "one of 5120 to 5123, 5125, 5126");
  }
  return impl_->Read<float>(json, components);
}

std::vector<uint32_t> GltfFile::ReadIndices(int accessor, const std::string& what) const {
  const GltfJson json = impl_->Accessor(accessor, what);
  if (json.String("type") != "SCALAR") json.FailValue("type", "SCALAR");
  const size_t type = json.RequiredWhole("componentType");
  if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    json.FailValue("componentType", "5121, 5123 or 5125 (unsigned integers)");
  }
  return impl_->Read<uint32_t>(json, 1);
}

}  // namespace lobe
