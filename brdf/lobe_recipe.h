#pragma once

#include <functional>
#include <optional>
#include <string>

#include "brdf/lobe_table.h"
#include "brdf/reflectance.h"

namespace lobe {

/// A part of a model as lobe tables see it: a scalar function, which materials of all colours share, and the
/// colours to multiply by; or data, whose channels are functions of their own.
struct LobeRecipe {
  /// Model and parameters; equal keys mean equal functions.
  std::string key;
  /// The part is f (plain + rising (1 - V.H)^5) in each channel.
  ScalarBrdf f;
  HalfVectorRule rule;
  Rgb plain = Rgb::Zero(), rising = Rgb::Zero();
  /// Directional albedo of f, where it is known in closed form and is not smooth at normal incidence, as the
  /// tables' own would have it. Empty: by integration.
  std::function<double(double cos_theta_i)> albedo = nullptr;
  /// If there, the part is this, in place of f and its colours.
  RgbBrdf channels = nullptr;
};

/// The gloss, if there is one that is not black and no ideal mirror.
std::optional<LobeRecipe> GlossRecipe(const Reflectance& r);

/// The base of models that have one of their own, if it is not black. None for Lambert (and Oren-Nayar of
/// sigma 0), whose base needs no table, and for metallic-roughness, whose base goes with its transmission
/// (brdf/material_lobes.cpp). `rising` is zero.
std::optional<LobeRecipe> BaseRecipe(const Reflectance& r);

}  // namespace lobe
