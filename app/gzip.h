#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lobe {

/// A gzip file (RFC 1952) of `bytes`: no name and no time in it, so that equal bytes give equal files.
std::vector<uint8_t> Gzip(std::span<const uint8_t> bytes);

}  // namespace lobe
