#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace lobe {

/// All bytes of a regular file of at most `most` bytes; throws InputError.
std::vector<uint8_t> ReadBytes(const std::string& path, size_t most = std::numeric_limits<size_t>::max());

}  // namespace lobe
