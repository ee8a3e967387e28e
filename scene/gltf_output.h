#pragma once

#include <nlohmann/json.hpp>

#include "scene/glb_writer.h"
#include "scene/scene.h"

namespace lobe {

/// Materials and cameras as glTF JSON: the mirror image of ReadMaterials and ReadCameras (gltf_scene.h),
/// which read back the same values, bit for bit (SolutionFileTest.MaterialsOfEveryModelComeBackUnchanged).

/// The fewest digits that read back as `value`: 0.1f as 0.1 rather than 0.10000000149011612. Infinities and
/// NaN, which JSON lacks, become null.
nlohmann::json JsonNumber(float value);

/// Standard glTF with KHR_materials_emissive_strength, _ior, _specular, _transmission, _volume and
/// _diffuse_transmission where needed. Models that glTF lacks go into LOBE_materials_brdf beside the nearest
/// that other programs can show. `writer`: the file that is to hold measured data; without one only its
/// digest is told, good for comparing.
nlohmann::json GltfMaterial(const Material& material, GlbWriter* writer = nullptr);

/// An entry of the document's `cameras`. `near_plane` in metres: glTF wants one, Lobe has none.
nlohmann::json GltfCamera(const Camera& camera, float near_plane);
/// The node that places it, `camera` being its index.
nlohmann::json GltfCameraNode(const Camera& camera, int index);

/// Names of all extensions used anywhere in a document, sorted: its `extensionsUsed`.
nlohmann::json ExtensionsUsed(const nlohmann::json& document);

}  // namespace lobe
