#include "app/gzip.h"

#include <algorithm>
#include <limits>
#include <new>

#include <zlib.h>

namespace lobe {

std::vector<uint8_t> Gzip(std::span<const uint8_t> bytes) {
  constexpr int kGzipOf32KiB = 15 + 16;  // zlib's way to ask for a gzip header, with its largest window
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzipOf32KiB, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();
  }
  // zlib counts in 32 bits, solutions may not: pieces in and out.
  std::vector<uint8_t> out, piece(size_t{1} << 18);
  size_t taken = 0;
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    const size_t now = std::min<size_t>(bytes.size() - taken, std::numeric_limits<int>::max());
    stream.next_in = const_cast<Bytef*>(bytes.data() + taken);
    stream.avail_in = uInt(now);
    stream.next_out = piece.data();
    stream.avail_out = uInt(piece.size());
    state = deflate(&stream, taken + now == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    taken += now - stream.avail_in;
    out.insert(out.end(), piece.data(), piece.data() + (piece.size() - stream.avail_out));
  }
  deflateEnd(&stream);
  return out;
}

}  // namespace lobe
