#include "app/program_path.h"

#ifdef __APPLE__
#include <mach-o/dyld.h>

#include <string>
#endif

namespace lobe {

std::filesystem::path ProgramFolder() {
  std::error_code error;
#ifdef __APPLE__
  uint32_t size = 0;
  _NSGetExecutablePath(nullptr, &size);
  std::string name(size, '\0');
  if (_NSGetExecutablePath(name.data(), &size) != 0) return {};
  return std::filesystem::canonical(name.c_str(), error).parent_path();
#else
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
#endif
}

}  // namespace lobe
