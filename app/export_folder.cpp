#include "app/export_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

#include <nlohmann/json.hpp>

#include "scene/input_error.h"

namespace lobe {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void FailToWrite(const std::string& path, int error) {
  throw InputError(path + ": cannot be written: " + std::strerror(error));
}

/// Where an export to `path` ends up, absolute, without a slash at its end.
fs::path Target(const std::string& path) {
  if (path.empty()) throw InputError("the name of the folder to export to is empty");
  std::error_code error;
  fs::path target = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) FailToWrite(path, error.value());
  if (!target.has_filename()) target = target.parent_path();
  if (fs::is_symlink(fs::symlink_status(target, error))) {
    throw InputError(path + ": is a symbolic link to nothing");
  }
  return target;
}

/// Names of the files that an earlier export into this folder wrote; empty if it is none.
std::set<std::string> EarlierExport(const fs::path& folder) {
  std::ifstream file(folder / kViewJson, std::ios::binary);
  const auto view = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  std::set<std::string> names;
  if (!view.is_object() || !view.contains("files") || !view["files"].is_array()) return names;
  for (const auto& name : view["files"]) {
    if (name.is_string()) names.insert(name.get<std::string>());
  }
  return names;
}

/// What takes a folder's place must be able to get its name.
void RequireRenameable(const std::string& path, const fs::path& target) {
  std::error_code error;
  if (fs::equivalent(target, fs::current_path(error), error)) {
    throw InputError(path + ": is the folder you are in, which cannot be replaced; name another");
  }
  struct stat folder, parent;
  if (stat(target.c_str(), &folder) == 0 && stat(target.parent_path().c_str(), &parent) == 0 &&
      folder.st_dev != parent.st_dev) {
    throw InputError(path +
                     ": is where a file system is mounted, which cannot be replaced; name a folder in it");
  }
}

void RequireReplaceable(const std::string& path, const fs::path& target) {
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) throw InputError(path + ": is a file, expected the name of a folder");
  RequireRenameable(path, target);
  std::set<std::string> ours = EarlierExport(target);
  for (const std::string& file : std::set<std::string>(ours)) {
    for (fs::path in = fs::path(file).parent_path(); !in.empty(); in = in.parent_path())
      ours.insert(in.generic_string());
  }
  // Not by its view.json alone: whatever else lies there would be lost.
  for (auto it = fs::recursive_directory_iterator(target, error); !error && it != fs::end(it);
       it.increment(error)) {
    const std::string name = it->path().lexically_relative(target).generic_string();
    if (ours.count(name) > 0) continue;
    throw InputError(path + ": holds '" + name +
                     "', which is not of an earlier export; choose another folder, or empty this one");
  }
  if (error) FailToWrite(path, error.value());
}

/// A folder under a passing name beside `target`, gone with all in it unless put in place.
class TemporaryFolder {
 public:
  TemporaryFolder(const std::string& path, const fs::path& target) : path_(path), target_(target) {
    for (int i = 0; i < 100; ++i) {
      name_ = target.parent_path() / (".lobe-" + std::to_string(getpid()) + "-" + std::to_string(i) + ".tmp");
      if (mkdir(name_.c_str(), 0777) == 0) return;
      if (errno != EEXIST) break;
    }
    FailToWrite(path_, errno);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(name_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  void Write(const std::string& name, const std::vector<uint8_t>& bytes) {
    const fs::path file = name_ / name;
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (error) FailToWrite(path_, error.value());
    FILE* stream = std::fopen(file.c_str(), "wbx");
    if (!stream) FailToWrite(path_, errno);
    // An empty vector has no data to point to.
    const bool all = bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
    const bool written = all && std::fflush(stream) == 0 && fsync(fileno(stream)) == 0;
    const int why = errno;
    if (std::fclose(stream) != 0 || !written) FailToWrite(path_, written ? errno : why);
  }

  void PutInPlace() {
    // What was private stays private.
    struct stat before;
    if (stat(target_.c_str(), &before) == 0) chmod(name_.c_str(), before.st_mode & 07777);
    for (const auto& entry : fs::recursive_directory_iterator(name_)) {
      if (entry.is_directory()) Flush(entry.path());
    }
    Flush(name_);
    Rename();
    Flush(target_.parent_path());
  }

 private:
  /// The names in a folder; some file systems cannot, and the files are whole anyway.
  static void Flush(const fs::path& folder) {
    const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    fsync(descriptor);
    close(descriptor);
  }

  void Rename() {
    if (rename(name_.c_str(), target_.c_str()) == 0) return;  // nothing there, or an empty folder
    if (errno != ENOTEMPTY && errno != EEXIST) FailToWrite(path_, errno);
#ifdef RENAME_EXCHANGE
    // The earlier export gets the passing name, and goes with it.
    if (renameat2(AT_FDCWD, name_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) return;
#endif
    // In two steps: between them the earlier export is there, but under a passing name.
    const fs::path old = name_.string() + "-old";
    if (rename(target_.c_str(), old.c_str()) != 0) FailToWrite(path_, errno);
    if (rename(name_.c_str(), target_.c_str()) != 0) {
      const int why = errno;
      rename(old.c_str(), target_.c_str());
      FailToWrite(path_, why);
    }
    std::error_code ignored;
    fs::remove_all(old, ignored);
  }

  std::string path_;
  fs::path target_, name_;
};

}  // namespace

void CheckExportFolder(const std::string& path) {
  const fs::path target = Target(path);
  RequireReplaceable(path, target);
  // Trying is the only honest test: permissions say nothing about read-only file systems.
  const TemporaryFolder attempt(path, target);
}

void WriteExportFolder(const std::string& path, const SiteFiles& site, const std::atomic<bool>& interrupted) {
  const fs::path target = Target(path);
  TemporaryFolder folder(path, target);
  const auto stop_if_asked = [&] {
    if (interrupted.load()) throw InputError(path + ": interrupted, nothing was written");
  };
  for (const auto& [name, bytes] : site) {
    stop_if_asked();
    folder.Write(name, bytes);
  }
  stop_if_asked();
  RequireReplaceable(path, target);  // as it is now
  folder.PutInPlace();
}

}  // namespace lobe
