#include "brdf/incident_moments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/hemisphere_basis.h"
#include "sh/simd.h"

namespace lobe {
namespace {

LOBE_SIMD_CLONES void AddScaled(float* out, const float* in, float a, int count) {
  for (int i = 0; i < count; ++i) out[i] += a * in[i];
}

LOBE_SIMD_CLONES void AddProducts(float* out, const float* a, const float* b, int count) {
  for (int i = 0; i < count; ++i) out[i] += a[i] * b[i];
}

}  // namespace

void IncidentMoments::Start(const MaterialLobes& material) {
  material_ = &material;
  l_max_ = material.max_degree();
  stride_ = 2 * (l_max_ + 1);
  moments_.assign(size_t(material.spline().bins()) * 3 * stride_, 0.0f);
  azimuth_.assign(stride_, 0.0f);
  first_bin_ = material.spline().bins();
  last_bin_ = -1;
  rest_base_ = rest_gloss_ = Rgb::Zero();
}

void IncidentMoments::Add(const Vec3& wi, const Rgb& irradiance) {
  const float s = std::hypot(wi.x(), wi.y());
  const float cos_phi = s > 0 ? wi.x() / s : 1.0f, sin_phi = s > 0 ? wi.y() / s : 0.0f;
  float* cos_m = azimuth_.data();
  float* sin_m = cos_m + l_max_ + 1;
  cos_m[0] = 1;
  sin_m[0] = 0;
  for (int m = 1; m <= l_max_; ++m) {
    cos_m[m] = cos_phi * cos_m[m - 1] - sin_phi * sin_m[m - 1];
    sin_m[m] = cos_phi * sin_m[m - 1] + sin_phi * cos_m[m - 1];
  }

  const auto stencil = material_->spline().At(wi.z());
  for (int k = 3; k >= 0; --k) {
    if (k == 0 && stencil.mirrored) {
      // The bin before the first is its mirror image: odd orders change sign. All other bins are done.
      for (int m = 1; m <= l_max_; m += 2) {
        cos_m[m] = -cos_m[m];
        sin_m[m] = -sin_m[m];
      }
    }
    float* bin = moments_.data() + size_t(stencil.bin[k]) * 3 * stride_;
    for (int c = 0; c < 3; ++c) {
      AddScaled(bin + c * stride_, azimuth_.data(), stencil.weight[k] * irradiance[c], stride_);
    }
  }
  first_bin_ = std::min({first_bin_, stencil.bin[0], stencil.bin[1]});
  last_bin_ = std::max(last_bin_, stencil.bin[3]);

  const FineAngle at(wi.z());
  const auto rest = [&](const PartLobes& part, Rgb& sum) {
    if (part.l_max < 0) return;
    for (int c = 0; c < 3; ++c) sum[c] += irradiance[c] * at.Read(part.flux_rest[c]);
  };
  rest(material_->base, rest_base_);
  rest(material_->gloss, rest_gloss_);
}

void IncidentMoments::Finish(float* base, float* gloss) {
  FinishPart(material_->base, rest_base_, base);
  FinishPart(material_->gloss, rest_gloss_, gloss);
}

void IncidentMoments::FinishPart(const PartLobes& part, const Rgb& rest, float* out) {
  if (part.l_max < 0) return;
  const int rows = part.RowCount(), l_max = part.l_max;
  for (int c = 0; c < 3; ++c) {
    product_.assign(2 * rows, 0.0f);  // cosine, then sine rows, ordered as PartLobes::Row
    float* cosine = product_.data();
    float* sine = cosine + rows;
    for (int bin = first_bin_; bin <= last_bin_; ++bin) {
      const float* control = part.control[c].data() + size_t(bin) * rows;
      const float* cos_m = moments_.data() + (size_t(bin) * 3 + c) * stride_;
      const float* sin_m = cos_m + l_max_ + 1;
      for (int step = 0, row = 0; 2 * step <= l_max; ++step) {
        const int orders = l_max - 2 * step + 1;
        AddProducts(cosine + row, control + row, cos_m, orders);
        AddProducts(sine + row, control + row, sin_m, orders);
        row += orders;
      }
    }
    float* lobe = out + size_t(c) * part.count();
    for (int step = 0, row = 0; 2 * step <= l_max; ++step) {
      for (int m = 0; m <= l_max - 2 * step; ++m, ++row) {
        const int l = m + 2 * step;
        lobe[CoefficientIndex(l, m)] += cosine[row];
        if (m > 0) lobe[CoefficientIndex(l, -m)] += sine[row];
      }
    }
    // A constant lobe of flux F has the coefficient F / pi * sqrt(2 pi).
    lobe[0] += rest[c] * std::sqrt(2.0f / std::numbers::pi_v<float>);
  }
}

}  // namespace lobe
