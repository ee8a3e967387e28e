#pragma once

#include <filesystem>
#include <string>

#include "tests/support/scratch_folder.h"

namespace lobe::test {

/// What stands in for the built page, so that no test needs npm: a file of every kind a page is made of.
inline std::string MakePage(const ScratchFolder& folder) {
  const std::string page = folder.File("page");
  std::filesystem::create_directories(page + "/assets");
  WriteWholeFile(page + "/index.html", "<!doctype html><title>stand-in</title>");
  for (const char* name : {"index.js", "index.css", "draco.wasm", "icon.svg", "font.woff2", "empty.json"}) {
    WriteWholeFile(page + "/assets/" + name,
                   std::string(name) == "empty.json" ? "" : std::string("this is ") + name);
  }
  return page;
}

}  // namespace lobe::test
