#include "scene/read_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "scene/input_error.h"

namespace lobe {

std::vector<uint8_t> ReadBytes(const std::string& path, size_t most) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path + ": is not a regular file");
  const uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw InputError(path + ": cannot be read: " + error.message());
  if (size > most) {
    throw InputError(path + ": holds " + std::to_string(size) + " bytes, expected at most " +
                     std::to_string(most));
  }
  std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw InputError(path + ": cannot be read: " + std::strerror(errno));
  std::vector<uint8_t> bytes(size);
  // An empty vector has no data to point to.
  if (!bytes.empty() && std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) {
    throw InputError(path + ": cannot be read to its end");
  }
  return bytes;
}

}  // namespace lobe
