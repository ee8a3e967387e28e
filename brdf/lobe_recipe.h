#pragma once

#include <functional>
#include <string>
#include <vector>

#include "brdf/lobe_table.h"
#include "brdf/reflectance.h"

namespace lobe {

/// A part of a model as lobe tables see it: scalar functions, which materials of all colours share, and the
/// colours to multiply by.
struct LobeRecipe {
  /// Model and parameters; equal keys mean equal `f`.
  std::string key;
  ScalarBrdf f;
  HalfVectorRule rule;
  /// The part is f (plain + rising (1 - V.H)^5) in each channel.
  Rgb plain = Rgb::Zero(), rising = Rgb::Zero();

  /// Directional albedo of f, where it is known in closed form and is not smooth at normal incidence, as the
  /// tables' own would have it. Empty: by integration.
  std::function<double(double cos_theta_i)> albedo = nullptr;

  bool black() const { return (plain <= 0).all() && (rising <= 0).all(); }
};

/// The gloss: empty if there is none (or it is an ideal mirror), one recipe for all channels, or three, one a
/// channel, of which each has a colour in that channel alone.
std::vector<LobeRecipe> GlossRecipes(const Reflectance& r);

/// The base of models that have one of their own; empty for Lambert (and Oren-Nayar of sigma 0), whose base
/// needs no table, and for metallic-roughness, whose base goes with its transmission
/// (brdf/material_lobes.cpp). `rising` is zero.
std::vector<LobeRecipe> BaseRecipes(const Reflectance& r);

}  // namespace lobe
