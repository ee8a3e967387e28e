#pragma once

namespace lobe {

/// Model x roughness (or exponent) x l_max: errors, negative part, albedo, knots, build time.
void BrdfFigures();
/// What --lobe-error takes: degree, knots, and the errors they leave.
void LobeErrorFigures();
/// Error and negative flux of lobes whose higher degrees are damped where they ring more than a bound.
void DeringFigures();
/// Fewest knots over the incident angle by how it is measured, and what they lose at grazing angles.
void IncidenceFigures();

}  // namespace lobe
