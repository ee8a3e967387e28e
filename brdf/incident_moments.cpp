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

// cos m phi, then sin m phi, for m <= l_max. Doubling: orders n+1 .. 2n are orders 1 .. n turned by n phi, so
// that the chain of dependent steps is short.
LOBE_SIMD_CLONES void AzimuthalFunctions(float cos_phi, float sin_phi, int l_max, float* out) {
  float* cos_m = out;
  float* sin_m = out + l_max + 1;
  cos_m[0] = 1;
  sin_m[0] = 0;
  if (l_max == 0) return;
  cos_m[1] = cos_phi;
  sin_m[1] = sin_phi;
  for (int n = 1; n < l_max; n *= 2) {
    const float c = cos_m[n], s = sin_m[n];
    const int count = std::min(n, l_max - n);
#pragma GCC ivdep
    for (int m = 1; m <= count; ++m) {
      const float cosine = c * cos_m[m] - s * sin_m[m];
      sin_m[n + m] = c * sin_m[m] + s * cos_m[m];
      cos_m[n + m] = cosine;
    }
  }
}

// out[c][i] = scale[c] * in[i].
LOBE_SIMD_CLONES void SetOuterProduct(float* out, const float* in, const float* scale, int count) {
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < count; ++i) out[c * count + i] = scale[c] * in[i];
  }
}

// Turns three spectra by the azimuth whose cos and sin of m phi are given.
LOBE_SIMD_CLONES void TurnSpectrum(float* spectrum, const float* azimuth, int orders) {
  const float* cos_m = azimuth;
  const float* sin_m = azimuth + orders;
  for (int c = 0; c < 3; ++c) {
    float* a = spectrum + 2 * c * orders;
    float* b = a + orders;
    for (int m = 0; m < orders; ++m) {
      const float turned = cos_m[m] * a[m] - sin_m[m] * b[m];
      b[m] = sin_m[m] * a[m] + cos_m[m] * b[m];
      a[m] = turned;
    }
  }
}

}  // namespace

void IncidentMoments::Start(const MaterialLobes& material) {
  material_ = &material;
  l_max_ = material.max_degree();
  stride_ = 2 * (l_max_ + 1);
  moments_.assign(size_t(material.spline().bins()) * 3 * stride_, 0.0f);
  azimuth_.assign(stride_, 0.0f);
  spectrum_.assign(3 * stride_, 0.0f);
  first_bin_ = material.spline().bins();
  last_bin_ = -1;
  rest_base_ = rest_gloss_ = Rgb::Zero();
}

// Puts spectrum_, which sums to `irradiance` in order 0, into the bins of its angle. Spoils spectrum_.
void IncidentMoments::AddSpectrum(float cos_theta_i, const Rgb& irradiance) {
  const auto stencil = material_->spline().At(cos_theta_i);
  for (int k = 3; k >= 0; --k) {
    if (k == 0 && stencil.mirrored) {
      // The bin before the first is its mirror image: odd orders change sign. All other bins are done.
      for (int row = 0; row < 6; ++row) {
        float* orders = spectrum_.data() + row * (l_max_ + 1);
        for (int m = 1; m <= l_max_; m += 2) orders[m] = -orders[m];
      }
    }
    AddScaled(moments_.data() + size_t(stencil.bin[k]) * 3 * stride_, spectrum_.data(), stencil.weight[k],
              3 * stride_);
  }
  first_bin_ = std::min({first_bin_, stencil.bin[0], stencil.bin[1]});
  last_bin_ = std::max(last_bin_, stencil.bin[3]);

  const FineAngle at(cos_theta_i);
  const auto rest = [&](const PartLobes& part, Rgb& sum) {
    if (part.l_max < 0) return;
    for (int c = 0; c < 3; ++c) sum[c] += irradiance[c] * at.Read(part.flux_rest[c]);
  };
  rest(material_->base, rest_base_);
  rest(material_->gloss, rest_gloss_);
}

void IncidentMoments::Add(const Vec3& wi, const Rgb& irradiance) {
  const float s = std::hypot(wi.x(), wi.y());
  AzimuthalFunctions(s > 0 ? wi.x() / s : 1.0f, s > 0 ? wi.y() / s : 0.0f, l_max_, azimuth_.data());
  SetOuterProduct(spectrum_.data(), azimuth_.data(), irradiance.data(), stride_);
  AddSpectrum(wi.z(), irradiance);
}

void IncidentMoments::AddRing(float cos_theta_i, const float* irradiance_planes, int count, float phi0) {
  const auto ring = rings_.try_emplace({count, l_max_}, count, l_max_).first;
  ring->second.Apply(irradiance_planes, spectrum_.data(), folded_);
  AzimuthalFunctions(std::cos(phi0), std::sin(phi0), l_max_, azimuth_.data());
  const Rgb sum(spectrum_[0], spectrum_[stride_], spectrum_[2 * stride_]);
  TurnSpectrum(spectrum_.data(), azimuth_.data(), l_max_ + 1);
  AddSpectrum(cos_theta_i, sum);
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
