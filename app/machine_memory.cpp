#include "app/machine_memory.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace lobe {
namespace {

// The line "MemAvailable: 1234 kB", Linux since 3.14.
double FromMeminfo() {
  std::ifstream file("/proc/meminfo");
  std::string name;
  double kilobytes = 0;
  while (file >> name >> kilobytes) {
    if (name == "MemAvailable:") return 1024 * kilobytes;
    file.ignore(1000, '\n');
  }
  return 0;
}

double NumberIn(const char* path) {
  std::ifstream file(path);
  double value = 0;
  return file >> value ? value : 0;  // "max" is no number: no limit
}

}  // namespace

double AvailableMemory() {
  double bytes = FromMeminfo();
#ifdef _SC_AVPHYS_PAGES
  if (bytes <= 0) bytes = double(sysconf(_SC_AVPHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
#endif
  // Control groups, version 2, as a container sees its own.
  const double limit = NumberIn("/sys/fs/cgroup/memory.max");
  if (limit > 0) {
    const double left = std::max(0.0, limit - NumberIn("/sys/fs/cgroup/memory.current"));
    bytes = bytes > 0 ? std::min(bytes, left) : left;
  }
  return std::max(0.0, bytes);
}

}  // namespace lobe
