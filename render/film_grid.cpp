#include "render/film_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {

double ChebyshevPoint(int i, int n) { return std::cos((2 * i + 1) * std::numbers::pi / (2 * n)); }

double FilmGrid::Bound(int l, double rho, int n) {
  constexpr double kLebesgue[kMaxPoints] = {1.0, 1.4143, 1.6667, 1.8478};
  double error = 2;
  for (int k = 0; k < n; ++k) error *= rho / 2 * (l + k) / (k + 1);
  return (1 + kLebesgue[n - 1]) * error;
}

int FilmGrid::Points(int l, double rho) {
  for (int n = 1; n <= kMaxPoints; ++n) {
    if (Bound(l, rho, n) <= kTolerance) return n;
  }
  return 0;
}

double FilmGrid::Rho(const CameraView::Film& film, float x0, float y0, float x1, float y1) {
  // The foot of the perpendicular from the eye: dx and dy are perpendicular to the view and to each other.
  const double along_x = film.dx.norm(), along_y = film.dy.norm();
  const double foot_x = -film.corner.dot(film.dx) / (along_x * along_x);
  const double foot_y = -film.corner.dot(film.dy) / (along_y * along_y);
  const double off_x = (std::clamp<double>(foot_x, x0, x1) - foot_x) * along_x;
  const double off_y = (std::clamp<double>(foot_y, y0, y1) - foot_y) * along_y;
  const double half = 0.5 * std::max((x1 - x0) * along_x, (y1 - y0) * along_y);
  return half / std::sqrt(1 + off_x * off_x + off_y * off_y);
}

void FilmGrid::Start(const CameraView::Film& film, float x0, float y0, float x1, float y1) {
  rho_ = Rho(film, x0, y0, x1, y1);
  centre_[0] = 0.5f * (x0 + x1);
  centre_[1] = 0.5f * (y0 + y1);
  scale_[0] = 2 / (x1 - x0);
  scale_[1] = 2 / (y1 - y0);
  const auto to_eye = [&](float x, float y) { return Vec3(-(film.corner + x * film.dx + y * film.dy)); };
  corners_[0] = to_eye(x0, y0);
  corners_[1] = to_eye(x1, y0);
  corners_[2] = to_eye(x0, y1);
  corners_[3] = to_eye(x1, y1);
  for (int n = 1; n <= kMaxPoints; ++n) {
    Directions& d = directions_[n - 1];
    for (int lane = 0; lane < kLanes; ++lane) {
      const int point = std::min(lane, n * n - 1);
      const Vec3 w = to_eye(centre_[0] + float(ChebyshevPoint(point % n, n)) / scale_[0],
                            centre_[1] + float(ChebyshevPoint(point / n, n)) / scale_[1])
                         .normalized();
      d.x[lane] = w.x();
      d.y[lane] = w.y();
      d.z[lane] = w.z();
    }
  }
}

bool FilmGrid::Above(const Vec3& normal) const {
  // A half-space is convex, so the corners answer for all that lies between them.
  return std::all_of(corners_, corners_ + 4, [&](const Vec3& w) { return normal.dot(w) >= 0; });
}

}  // namespace lobe
