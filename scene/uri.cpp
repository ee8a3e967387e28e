#include "scene/uri.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>

namespace lobe {

std::string PercentDecoded(const std::string& uri) {
  std::string decoded;
  for (size_t i = 0; i < uri.size(); ++i) {
    int byte = 0;
    if (uri[i] == '%' && i + 2 < uri.size() && std::sscanf(uri.substr(i + 1, 2).c_str(), "%2x", &byte) == 1) {
      decoded += static_cast<char>(byte);
      i += 2;
    } else {
      decoded += uri[i];
    }
  }
  return decoded;
}

std::string FileOfUri(const std::string& document_path, const std::string& uri) {
  return (std::filesystem::path(document_path).parent_path() / PercentDecoded(uri)).string();
}

std::string Extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace lobe
