#include "scene/measured_file.h"

#include "scene/goniometer_file.h"
#include "scene/merl_file.h"
#include "scene/uri.h"

namespace lobe {

Measured ReadMeasuredFile(const std::string& path) {
  return Extension(path) == ".binary" ? ReadMerlFile(path) : ReadGoniometerFile(path);
}

}  // namespace lobe
