#include "app/site.h"

#include <filesystem>

#include <nlohmann/json.hpp>

#include "app/gzip.h"
#include "app/program_path.h"
#include "scene/input_error.h"
#include "scene/read_file.h"
#include "solver/trust.h"

namespace lobe {
namespace {

namespace fs = std::filesystem;

constexpr const char *kPage = "index.html", *kPlain = "solution.glb", *kPacked = "solution.glb.gz";
constexpr const char* kHowToGet =
    "; the page that shows solutions is built with Lobe where Node.js 18 or newer and npm are installed: "
    "install "
    "them, then configure and build again (--viewer DIR names a page built elsewhere)";

bool HoldsPage(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / kPage, error);
}

fs::path FindViewer(const std::optional<std::string>& given) {
  if (given) {
    if (!HoldsPage(*given)) throw InputError(*given + ": holds no " + kPage + kHowToGet);
    // viewer/ of the source has an index.html too, of a page still to be built.
    std::error_code error;
    if (fs::exists(fs::path(*given) / "package.json", error)) {
      throw InputError(*given +
                       ": holds the page's source, expected the page that `npm run build` makes of it");
    }
    return *given;
  }
  const fs::path program = ProgramFolder();
  for (const char* place : {"../share/lobe/viewer", "../viewer"}) {
    if (HoldsPage(program / place)) return program / place;
  }
  throw InputError((program / "../share/lobe/viewer").lexically_normal().string() + ": is not there" +
                   kHowToGet);
}

}  // namespace

SiteFiles ReadViewer(const std::optional<std::string>& given) {
  const fs::path folder = FindViewer(given);
  SiteFiles site;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (!entry.is_regular_file()) continue;
      site[entry.path().lexically_relative(folder).generic_string()] = ReadBytes(entry.path().string());
    }
  } catch (const fs::filesystem_error& e) {
    throw InputError(folder.string() + ": cannot be read: " + e.code().message());
  }
  return site;
}

PackedSolution AddSolution(const std::string& path, const SitePacking& packing, SiteFiles* site) {
  PackedSolution packed;
  std::vector<uint8_t> bytes;
  {
    const Solution solution = ReadSolution(path);
    packed.nodes = solution.mesh.node_count();
    if (const std::string sentence = TrustSentence(solution); !sentence.empty()) {
      packed.trust = path + ": " + sentence;
    }
    bytes = ViewingFile(solution, packing.precision, path + " reduced to what viewing needs");
  }
  if (packing.gzip) bytes = Gzip(bytes);
  packed.file = packing.gzip ? kPacked : kPlain;
  packed.bytes = bytes.size();
  // An earlier export may serve as the page; its solution is not this one.
  for (const char* name : {kPlain, kPacked}) site->erase(name);
  (*site)[packed.file] = std::move(bytes);

  nlohmann::json view = {
      {"solution", packed.file}, {"title", fs::path(path).filename().string()}, {"version", LOBE_VERSION}};
  (*site)[kViewJson];
  for (const auto& [name, unused] : *site) view["files"].push_back(name);
  const std::string text = view.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  (*site)[kViewJson].assign(text.begin(), text.end());
  return packed;
}

size_t TotalBytes(const SiteFiles& site) {
  size_t sum = 0;
  for (const auto& [name, bytes] : site) sum += bytes.size();
  return sum;
}

}  // namespace lobe
