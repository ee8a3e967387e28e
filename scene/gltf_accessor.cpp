#include "scene/gltf_accessor.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

namespace lobe {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian and read in place");

namespace {

// accessor.componentType, glTF 2.0 section 3.6.2.2
constexpr size_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                 kUnsignedInt = 5125, kFloat = 5126;

size_t ComponentBytes(size_t component_type) {
  switch (component_type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

bool IsUnsignedInteger(size_t component_type) {
  return component_type == kUnsignedByte || component_type == kUnsignedShort ||
         component_type == kUnsignedInt;
}

/// MAT2 and MAT3 have padded columns, and nothing we read is of such type.
std::string TypeName(int components) {
  return components == 1 ? "SCALAR" : components == 16 ? "MAT4" : "VEC" + std::to_string(components);
}

/// Calls use(From{}), where From is the C++ type of a component.
template <typename Use>
void WithComponentType(size_t component_type, const Use& use) {
  switch (component_type) {
    case kByte:
      return use(int8_t{});
    case kUnsignedByte:
      return use(uint8_t{});
    case kShort:
      return use(int16_t{});
    case kUnsignedShort:
      return use(uint16_t{});
    case kUnsignedInt:
      return use(uint32_t{});
    default:
      return use(float{});
  }
}

}  // namespace

struct GltfAccessors::Elements {
  const uint8_t* data = nullptr;
  size_t stride = 0;
  size_t count = 0;

  /// Normalised integers become max(c / largest, -1), section 3.11.
  template <typename To>
  void Convert(size_t component_type, int components, bool normalized, To* to) const {
    WithComponentType(component_type, [&](auto from) {
      using From = decltype(from);
      if (std::is_same_v<From, To> && stride == components * sizeof(From)) {
        std::memcpy(to, data, count * stride);
        return;
      }
      for (size_t i = 0; i < count; ++i) {
        for (int k = 0; k < components; ++k) {
          From value;
          std::memcpy(&value, data + i * stride + k * sizeof(From), sizeof(From));
          To converted = static_cast<To>(value);
          if constexpr (std::is_integral_v<From> && std::is_floating_point_v<To>) {
            constexpr To kLargest = static_cast<To>(std::numeric_limits<From>::max());
            if (normalized) converted = std::max(converted / kLargest, To{-1});
          }
          *to++ = converted;
        }
      }
    });
  }
};

GltfJson GltfAccessors::Accessor(int accessor, const std::string& what) const {
  const size_t count = document_.Count("accessors");
  if (accessor < 0 || static_cast<size_t>(accessor) >= count) {
    document_.Fail(what + ": accessor " + std::to_string(accessor) + " does not exist; the file has " +
                   std::to_string(count));
  }
  return document_.Entry("accessors", accessor, what + ": accessor");
}

/// `owner` (an accessor or a part of its sparse override) has bufferView and byteOffset. `count` > 0.
GltfAccessors::Elements GltfAccessors::Locate(const GltfJson& owner, size_t count, size_t element_bytes,
                                              bool may_stride) const {
  const int view_index = owner.Index("bufferView", document_.Count("bufferViews"));
  if (view_index < 0) owner.FailValue("bufferView", "an index");
  const GltfJson view = document_.Entry("bufferViews", view_index, owner.element() + ": bufferView");
  const int buffer = view.Index("buffer", buffers_.size());
  if (buffer < 0) view.FailValue("buffer", "an index");

  // Whole numbers are at most 2^53, counts 2^32 and strides 2^16: no sum overflows.
  const size_t view_offset = view.Whole("byteOffset", 0);
  const size_t view_length = view.RequiredWhole("byteLength");
  if (view_offset + view_length > buffers_[buffer].size()) {
    view.Fail("it spans bytes " + std::to_string(view_offset) + " to " +
              std::to_string(view_offset + view_length) + ", but buffer " + std::to_string(buffer) + " has " +
              std::to_string(buffers_[buffer].size()));
  }
  Elements elements;
  elements.count = count;
  elements.stride = may_stride ? view.Whole("byteStride", element_bytes, 1 << 16) : element_bytes;
  if (elements.stride < element_bytes) {
    view.FailValue("byteStride", "at least " + std::to_string(element_bytes) + ", the size of an element");
  }
  const size_t offset = owner.Whole("byteOffset", 0);
  const size_t end = offset + (count - 1) * elements.stride + element_bytes;
  if (end > view_length) {
    owner.Fail(std::to_string(count) + " elements end at byte " + std::to_string(end) + " of bufferView " +
               std::to_string(view_index) + ", which has " + std::to_string(view_length));
  }
  elements.data = buffers_[buffer].data() + view_offset + offset;
  return elements;
}

template <typename To>
std::vector<To> GltfAccessors::Read(const GltfJson& accessor, int components) const {
  constexpr size_t kMostElements = size_t{1} << 32;
  const size_t component_type = accessor.RequiredWhole("componentType");
  const size_t count = accessor.RequiredWhole("count", kMostElements);
  if (count == 0) accessor.FailValue("count", "at least 1");
  const bool normalized = accessor.Bool("normalized", false);

  std::vector<To> values;
  if (accessor.Has("bufferView")) {
    const Elements elements = Locate(accessor, count, components * ComponentBytes(component_type), true);
    values.resize(count * components);
    elements.Convert(component_type, components, normalized, values.data());
  } else {
    // All zeros, with no data in the file that would bound the count.
    constexpr size_t kMostZeros = size_t{1} << 24;  // chosen: 200 MB of VEC3
    if (count > kMostZeros) {
      accessor.FailValue("count", "at most " + std::to_string(kMostZeros) + " without a bufferView");
    }
    values.resize(count * components);
  }
  if (accessor.Has("sparse")) {
    Override(accessor.Object("sparse"), component_type, components, normalized, &values);
  }
  return values;
}

template <typename To>
void GltfAccessors::Override(const GltfJson& sparse, size_t component_type, int components, bool normalized,
                             std::vector<To>* values) const {
  const size_t total = values->size() / components;
  const size_t count = sparse.RequiredWhole("count", total);
  if (count == 0) return;
  const GltfJson where = sparse.Object("indices");
  const size_t index_type = where.RequiredWhole("componentType");
  if (!IsUnsignedInteger(index_type)) where.FailValue("componentType", "5121, 5123 or 5125");
  const Elements index_elements = Locate(where, count, ComponentBytes(index_type), false);
  const Elements value_elements =
      Locate(sparse.Object("values"), count, components * ComponentBytes(component_type), false);
  std::vector<uint32_t> indices(count);
  index_elements.Convert(index_type, 1, false, indices.data());
  std::vector<To> replacements(count * components);
  value_elements.Convert(component_type, components, normalized, replacements.data());
  for (size_t i = 0; i < count; ++i) {
    if (indices[i] >= total) {
      sparse.Fail("sparse index " + std::to_string(i) + " is " + std::to_string(indices[i]) +
                  ", expected below " + std::to_string(total));
    }
    std::copy_n(&replacements[i * components], components, &(*values)[size_t{indices[i]} * components]);
  }
}

int GltfAccessors::Count(int accessor) const {
  const GltfJson json = Accessor(accessor, "document");
  return static_cast<int>(json.RequiredWhole("count", std::numeric_limits<int>::max()));
}

std::vector<float> GltfAccessors::ReadFloats(int accessor, int components, const std::string& what) const {
  const GltfJson json = Accessor(accessor, what);
  if (json.String("type") != TypeName(components)) json.FailValue("type", TypeName(components));
  if (ComponentBytes(json.RequiredWhole("componentType")) == 0) {
    json.FailValue("componentType", "one of 5120 to 5123, 5125, 5126");
  }
  return Read<float>(json, components);
}

std::vector<uint32_t> GltfAccessors::ReadIndices(int accessor, const std::string& what) const {
  const GltfJson json = Accessor(accessor, what);
  if (json.String("type") != "SCALAR") json.FailValue("type", "SCALAR");
  if (!IsUnsignedInteger(json.RequiredWhole("componentType"))) {
    json.FailValue("componentType", "5121, 5123 or 5125 (unsigned integers)");
  }
  return Read<uint32_t>(json, 1);
}

}  // namespace lobe
