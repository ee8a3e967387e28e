#include "render/film_grid.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "sh/hemisphere_basis.h"

namespace lobe {
namespace {

double Value(const std::vector<double>& lobe, const HemisphereBasis<double>& basis, const Vec3d& w) {
  std::vector<double> h(basis.size());
  basis.Evaluate(w.x(), w.y(), w.z(), h.data());
  double sum = 0;
  for (int k = 0; k < basis.size(); ++k) sum += lobe[k] * h[k];
  return sum;
}

double LagrangeFunction(int i, int n, double s) {
  double product = 1;
  for (int k = 0; k < n; ++k) {
    if (k != i) product *= (s - ChebyshevPoint(k, n)) / (ChebyshevPoint(i, n) - ChebyshevPoint(k, n));
  }
  return product;
}

// Random lobes, and zonal peaks along the view, which are the worst: tiles in the middle and in a corner of
// narrow and of very wide films.
TEST(FilmGridTest, InterpolationErrsByNoMoreThanItsBound) {
  std::mt19937 bits(7);
  std::normal_distribution<double> normal;
  double closest = 0;
  for (const float fov : {0.1f, 0.7f, 2.9f}) {
    const Camera camera = LookAt({0, 0, 0}, {0.3f, 0.2f, -1}, Vec3::UnitY(), fov);
    const CameraView::Film film = CameraView(camera, 64, 64).film();
    for (const float x0 : {0.0f, 28.0f}) {
      const float x1 = x0 + 8, y0 = 24, y1 = 32;
      const double rho = FilmGrid::Rho(film, x0, y0, x1, y1);
      const auto direction = [&](double s, double t) {
        const float x = float(x0 + (s + 1) / 2 * (x1 - x0)), y = float(y0 + (t + 1) / 2 * (y1 - y0));
        return Vec3d(-(film.corner + x * film.dx + y * film.dy).cast<double>().normalized());
      };
      for (const int l : {1, 3, 8, 20}) {
        const HemisphereBasis<double> basis(l);
        for (const bool peak : {false, true}) {
          std::vector<double> lobe(basis.size());
          if (peak) {
            const Vec3d at = direction(0.3, -0.2);
            basis.Evaluate(at.x(), at.y(), at.z(), lobe.data());
          } else {
            for (double& c : lobe) c = normal(bits);
          }
          double size = 0;  // a little too small is on the safe side: it makes the test stricter
          for (int i = 0; i < 3000; ++i) {
            size = std::max(
                size,
                std::abs(Value(lobe, basis, Vec3d(normal(bits), normal(bits), normal(bits)).normalized())));
          }
          for (int i = 0; i < 25; ++i)
            size = std::max(size, std::abs(Value(lobe, basis, direction(i / 12. - 1, 0))));
          for (int n = 2; n <= FilmGrid::kMaxPoints; ++n) {
            double worst = 0;
            for (int a = 0; a <= 10; ++a) {
              for (int b = 0; b <= 10; ++b) {
                const double s = a / 5.0 - 1, t = b / 5.0 - 1;
                double sum = 0;
                for (int i = 0; i < n; ++i) {
                  for (int j = 0; j < n; ++j) {
                    sum += LagrangeFunction(i, n, s) * LagrangeFunction(j, n, t) *
                           Value(lobe, basis, direction(ChebyshevPoint(i, n), ChebyshevPoint(j, n)));
                  }
                }
                worst = std::max(worst, std::abs(sum - Value(lobe, basis, direction(s, t))));
              }
            }
            // Film positions are floats here.
            const double bound = FilmGrid::Bound(l, rho, n) * size + 1e-5 * size * l;
            EXPECT_LE(worst, bound) << "fov " << fov << ", l " << l << ", n " << n;
            closest = std::max(closest, worst / bound);
          }
        }
      }
    }
  }
  EXPECT_GT(closest, 0.02) << "a bound a hundred times too large would say nothing";
}

TEST(FilmGridTest, TakesAsFewPointsAsTheToleranceAllows) {
  EXPECT_EQ(FilmGrid::Points(0, 0.5), 1);
  EXPECT_EQ(FilmGrid::Points(20, 1.0), 0) << "no grid serves";
  for (const int l : {1, 4, 12, 20}) {
    for (const double rho : {1e-4, 1e-3, 0.004, 0.01, 0.03, 0.1}) {
      const int n = FilmGrid::Points(l, rho);
      if (n > 0) {
        EXPECT_LE(FilmGrid::Bound(l, rho, n), FilmGrid::kTolerance);
      }
      const int fewer = n > 0 ? n - 1 : FilmGrid::kMaxPoints;
      if (fewer > 0) {
        EXPECT_GT(FilmGrid::Bound(l, rho, fewer), FilmGrid::kTolerance);
      }
    }
  }
}

TEST(FilmGridTest, SaysWhetherAllDirectionsAreAboveAHorizon) {
  const Camera camera = LookAt({0, 0, 0}, {0, 0, -1}, Vec3::UnitY(), 1.0f);
  FilmGrid grid;
  grid.Start(CameraView(camera, 16, 16).film(), 0, 0, 16, 16);  // half the film's height is tan 0.5
  EXPECT_TRUE(grid.Above({0, 0, 1}));
  EXPECT_FALSE(grid.Above({0, 0, -1}));
  EXPECT_TRUE(grid.Above(Vec3(std::cos(0.6f), 0, std::sin(0.6f))));
  EXPECT_FALSE(grid.Above(Vec3(std::cos(0.4f), 0, std::sin(0.4f)))) << "its left or right edge is below";
}

}  // namespace
}  // namespace lobe
