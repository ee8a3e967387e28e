#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace lobe {

/// Builds a .glb: a JSON document and one binary buffer.
class GlbWriter {
 public:
  nlohmann::json document;  ///< accessors, bufferViews, buffers are filled by the calls below

  GlbWriter();

  enum class Target { kNone = 0, kVertices = 34962, kIndices = 34963 };
  /// Appends an accessor and returns its index. `type`: "SCALAR", "VEC3", … VEC3 positions get min and
  /// max when `bounds`.
  int AddFloats(std::span<const float> values, const std::string& type, Target target, bool bounds = false);
  int AddUints(std::span<const uint32_t> values, Target target);
  int AddBytes(std::span<const uint8_t> values);
  /// Unsigned short SCALAR: two bytes each that mean what the caller's extension says.
  int AddShorts(std::span<const uint16_t> values);

  /// Takes memory for so many bytes of accessors at once; growing into it piece by piece would take twice as
  /// much.
  void Reserve(size_t bytes) { buffer_.reserve(bytes); }

  /// Writes to a temporary name beside `path`, flushes to disk, renames: `path` is absent, what it was,
  /// or complete, whatever happens. A name ending in .gltf gets a .bin beside it (needed above 4 GiB).
  /// Throws InputError (unwritable, a directory, disk full, a .bin of that name which is not this file's).
  void Write(const std::string& path);
  /// The bytes of the .glb that Write would make; messages call it `name`. Throws InputError at 4 GiB.
  std::vector<uint8_t> Glb(const std::string& name) const;

 private:
  int AddView(const void* data, size_t bytes, Target target);
  int AddUnsigned(const void* data, size_t bytes, size_t count, int component_type, Target target);
  /// The document with its buffer told, which lies at `uri`, or if empty in the .glb itself.
  nlohmann::json WithBuffer(const std::string& uri = {}) const;
  size_t PaddedBytes() const { return (buffer_.size() + 3) / 4 * 4; }
  std::vector<uint8_t> buffer_;
};

/// Writes `bytes` to `path` by a temporary file, flush and rename. Throws InputError.
void WriteFileAtomically(const std::string& path, std::span<const uint8_t> bytes);

/// Throws InputError if `path` could not be written: its folder missing or read-only, or a directory by
/// that name. Asked before long work, so that nothing is computed in vain.
void CheckWritable(const std::string& path);

}  // namespace lobe
