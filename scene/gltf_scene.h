#pragma once

#include <string>

#include "scene/gltf_file.h"
#include "scene/scene.h"

namespace lobe {

/// Reads a scene: node hierarchy with negative scale, all index types, strips and fans, sparse and
/// normalised accessors, instancing, missing normals (flat, as the specification says), doubleSided,
/// KHR_materials_emissive_strength, _specular, _ior, _transmission, _volume, _diffuse_transmission, cameras.
/// Zero-area triangles are dropped with a warning, and so is what lies under other faces in their plane
/// (scene/coincident_faces.h); what is not read (textures, glass, lights, skins, morph
/// targets, animation) is named in a warning with what is used instead. Throws InputError.
Scene ReadGltfScene(const std::string& path);
Scene ReadGltfScene(const GltfFile& file);

/// The parts of it that the solution's reader shares.
std::vector<Material> ReadMaterials(const GltfFile& file, std::vector<std::string>* warnings);
std::vector<Camera> ReadCameras(const GltfFile& file);

}  // namespace lobe
