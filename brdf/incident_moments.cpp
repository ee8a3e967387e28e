#include "brdf/incident_moments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/hemisphere_basis.h"
#include "sh/lanes.h"
#include "sh/simd.h"

namespace lobe {
namespace {

// Adds a spectrum, times a weight, to each of `count` bins. `size` is a multiple of kLanes.
LOBE_SIMD_CLONES void AddToBins(float* moments, size_t size, const float* spectrum, const int* bin,
                                const float* weight, int count) {
  for (size_t i = 0; i < size; i += kLanes) {
    const FloatLanes value = Loose(spectrum + i);
    for (int k = 0; k < count; ++k) {
      LooseLanes& to = Loose(moments + bin[k] * size + i);
      to = to + weight[k] * value;
    }
  }
}

// out[c][cos m phi, sin m phi] = scale[c] * those, for m <= l_max, then up to 15 floats of rubbish. Sixteen
// orders side by side, as in LobeReader. `azimuth` is scratch for whole blocks of orders, twice.
LOBE_SIMD_CLONES void OneDirection(float x, float y, int l_max, const float* scale, float* azimuth,
                                   float* out) {
  AzimuthLanes powers(x, y);
  const int blocks = l_max / kLanes + 1;
  float* sines = azimuth + blocks * kLanes;
  for (int block = 0; block < blocks; ++block) {
    Loose(azimuth + block * kLanes) = powers.cosine;
    Loose(sines + block * kLanes) = powers.sine;
    powers.Advance();
  }
  // What is written past the last order is written over by what follows.
  for (int c = 0; c < 3; ++c) {
    for (const float* from : {static_cast<const float*>(azimuth), static_cast<const float*>(sines)}) {
      for (int block = 0; block < blocks; ++block) {
        Loose(out + block * kLanes) = scale[c] * Loose(from + block * kLanes);
      }
      out += l_max + 1;
    }
  }
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
  bin_size_ = (size_t(3) * stride_ + kLanes - 1) / kLanes * kLanes;
  moments_.assign(size_t(material.spline().bins()) * bin_size_, 0.0f);
  azimuth_.assign(2 * (size_t(l_max_) / kLanes + 1) * kLanes, 0.0f);
  spectrum_.assign(bin_size_ + kLanes, 0.0f);
  first_bin_ = material.spline().bins();
  last_bin_ = -1;
  unsettled_ = 0;
  any_settled_ = false;
  rest_base_ = rest_gloss_ = Eigen::Array3d::Zero();
}

// Puts spectrum_, which sums to `irradiance` in order 0, into the bins of its angle. Spoils spectrum_.
void IncidentMoments::AddSpectrum(float cos_theta_i, const Rgb& irradiance) {
  if (unsettled_ == kSettleAfter) Settle();
  ++unsettled_;
  const auto stencil = material_->spline().At(cos_theta_i);
  const int apart = stencil.mirrored ? 1 : 0;
  AddToBins(moments_.data(), bin_size_, spectrum_.data(), stencil.bin + apart, stencil.weight + apart,
            4 - apart);
  if (stencil.mirrored) {
    // The bin before the first is its mirror image: odd orders change sign.
    for (int row = 0; row < 6; ++row) {
      float* orders = spectrum_.data() + row * (l_max_ + 1);
      for (int m = 1; m <= l_max_; m += 2) orders[m] = -orders[m];
    }
    AddToBins(moments_.data(), bin_size_, spectrum_.data(), stencil.bin, stencil.weight, 1);
  }
  first_bin_ = std::min({first_bin_, stencil.bin[0], stencil.bin[1]});
  last_bin_ = std::max(last_bin_, stencil.bin[3]);

  const FineAngle at(cos_theta_i);
  const auto rest = [&](const PartLobes& part, Eigen::Array3d& sum) {
    if (part.l_max < 0) return;
    for (int c = 0; c < 3; ++c) sum[c] += irradiance[c] * at.Read(part.flux_rest[c]);
  };
  rest(material_->base, rest_base_);
  rest(material_->gloss, rest_gloss_);
}

void IncidentMoments::Add(const Vec3& wi, const Rgb& irradiance) {
  // At the pole an azimuth means nothing, and so near it squares would lose their digits.
  constexpr float kPole = 1e-15f;
  const float s2 = wi.x() * wi.x() + wi.y() * wi.y();
  const bool pole = !(s2 > kPole * kPole);
  const float scale = pole ? 0.0f : 1.0f / std::sqrt(s2);
  OneDirection(pole ? 1.0f : wi.x() * scale, wi.y() * scale, l_max_, irradiance.data(), azimuth_.data(),
               spectrum_.data());
  AddSpectrum(wi.z(), irradiance);
}

void IncidentMoments::Settle() {
  if (!any_settled_) settled_.assign(moments_.size(), 0.0);
  any_settled_ = true;
  unsettled_ = 0;
  for (size_t i = first_bin_ * bin_size_; i < (last_bin_ + 1) * bin_size_; ++i) {
    settled_[i] += moments_[i];
    moments_[i] = 0;
  }
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
  const float* moments = moments_.data();
  if (any_settled_) {
    Settle();
    settled_sum_.resize(settled_.size());
    std::copy(settled_.begin(), settled_.end(), settled_sum_.begin());
    moments = settled_sum_.data();
  }
  FinishPart(material_->base, rest_base_, moments, base);
  FinishPart(material_->gloss, rest_gloss_, moments, gloss);
}

void IncidentMoments::FinishPart(const PartLobes& part, const Eigen::Array3d& rest, const float* moments,
                                 float* out) {
  if (part.l_max < 0) return;
  const int rows = part.RowCount(), l_max = part.l_max;
  for (int c = 0; c < 3; ++c) {
    product_.assign(2 * rows, 0.0f);  // cosine, then sine rows, ordered as PartLobes::Row
    float* cosine = product_.data();
    float* sine = cosine + rows;
    for (int bin = first_bin_; bin <= last_bin_; ++bin) {
      const float* control = part.control[c].data() + size_t(bin) * rows;
      const float* cos_m = moments + size_t(bin) * bin_size_ + size_t(c) * stride_;
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
    lobe[0] += float(rest[c]) * std::sqrt(2.0f / std::numbers::pi_v<float>);
  }
}

}  // namespace lobe
