#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lobe {

using Vec3 = Eigen::Vector3f;  ///< point (metres) or direction (unit), single precision
using Vec3d = Eigen::Vector3d;

}  // namespace lobe
