#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "solver/viewing_file.h"

namespace lobe {

/// The files of a static web site by name, such as "assets/index.js".
using SiteFiles = std::map<std::string, std::vector<uint8_t>>;

/// The page that shows solutions, as viewer/ builds it: all files of `folder`, or if that is not given, of
/// the folder beside this program (installed: ../share/lobe/viewer; built: ../viewer). Throws InputError
/// saying how to get it if it is not there.
SiteFiles ReadViewer(const std::optional<std::string>& folder);

/// How a solution is handed to the page.
struct SitePacking {
  ViewingPrecision precision = ViewingPrecision::kFloat;
  bool gzip = false;  ///< as solution.glb.gz, which the page inflates itself: any server will do
};

/// What was added to a site.
struct PackedSolution {
  std::string file;  ///< "solution.glb" or "solution.glb.gz"
  size_t nodes = 0, bytes = 0;
  std::string trust;  ///< what is to be said of it (solver/trust.h), with its path; empty: nothing
};

/// Adds the solution at `path` and view.json, which tells the page its file, its title and Lobe's version,
/// and `lobe export` what is in the folder. Throws InputError if there is no complete solution at `path`.
PackedSolution AddSolution(const std::string& path, const SitePacking& packing, SiteFiles* site);

inline constexpr const char* kViewJson = "view.json";

/// In bytes, all of them.
size_t TotalBytes(const SiteFiles& site);

}  // namespace lobe
