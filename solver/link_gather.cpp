#include "solver/link_gather.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "brdf/frame.h"
#include "sh/degree_cut.h"
#include "sh/hemisphere_basis.h"

namespace lobe {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Which sector of a ring a thinned sweep starts with: rings next to each other start apart.
int FirstSector(int ring, int thinning) { return thinning == 1 ? 0 : (5 * ring) % thinning; }

}  // namespace

LinkField::LinkField(const Scene& scene, const Mesh& mesh) : scene_(scene), mesh_(mesh) {}

LinkField::LinkField(const Scene& scene, const Mesh& mesh, const NodeLobes& lobes,
                     const std::vector<int>& degrees)
    : scene_(scene), mesh_(mesh), emission_(false), radiance_(mesh.node_count()) {
  std::map<std::pair<int, int>, DegreeCut> cuts;  // from, to
  const auto sent = [&](uint32_t patch, int degree) {
    return degrees.empty() ? degree : std::min(degree, degrees[patch]);
  };
  size_t packed = 0;
  for (uint32_t p = 0; p < mesh.patches.size(); ++p) {
    const PartDegrees& d = lobes.patch_degrees(p);
    reader_of_patch_.push_back(nullptr);
    packed_begin_.push_back(packed);
    for (const int degree : {d.base, d.gloss}) {
      if (sent(p, degree) < degree) cuts.try_emplace({degree, sent(p, degree)}, degree, sent(p, degree));
    }
    const int highest = sent(p, d.max_degree());
    if (highest <= 0) continue;
    reader_of_patch_.back() = &readers_.try_emplace(highest, highest).first->second;
    packed +=
        reader_of_patch_.back()->packed_size() * (mesh.patches[p].node_end - mesh.patches[p].node_begin);
  }
  packed_.resize(packed, 0.0f);
  const float scale = 1.0f / std::sqrt(2.0f * kPi);
  tbb::enumerable_thread_specific<std::vector<float>> scratches;
  tbb::parallel_for(uint32_t(0), uint32_t(mesh.node_count()), [&](uint32_t n) {
    const uint32_t patch = mesh.node_patch[n];
    const PartDegrees& d = lobes.patch_degrees(patch);
    radiance_[n] = {0, 0, 0, 0};
    const LobeReader* reader = reader_of_patch_[patch];
    if (reader) {
      const auto all = lobes.all(n);
      if (std::all_of(all.begin(), all.end(), [](float v) { return v == 0; })) return;
      radiance_[n][3] = 1;
    }
    const auto add = [&](const float* part, int degree) {
      if (degree < 0) return;
      const int to = sent(patch, degree);
      if (to < degree) {
        std::vector<float>& cut = scratches.local();
        cut.resize(3 * size_t(CoefficientCount(to)));
        const DegreeCut& lower = cuts.at({degree, to});
        for (int c = 0; c < 3; ++c) {
          lower.Apply(part + c * CoefficientCount(degree), cut.data() + c * CoefficientCount(to));
        }
        part = cut.data();
      }
      if (reader) {
        reader->Pack(part, to, packed_.data() + PackedAt(n));
      } else {
        for (int c = 0; c < 3; ++c) radiance_[n][c] += part[c] * scale;
      }
    };
    add(lobes.base(n), d.base);
    add(lobes.gloss(n), d.gloss);
  });
}

size_t LinkField::PackedAt(uint32_t node) const {
  const uint32_t p = mesh_.node_patch[node];
  return packed_begin_[p] + reader_of_patch_[p]->packed_size() * (node - mesh_.patches[p].node_begin);
}

Rgb LinkField::Read(uint32_t node, const Vec3& wo_world) const {
  const Vec3 wo = Frame(mesh_.node_normal[node]).ToLocal(wo_world);
  if (wo.z() < 0) return Rgb::Zero();
  const auto rgb =
      reader_of_patch_[mesh_.node_patch[node]]->Read(packed_.data() + PackedAt(node), wo.x(), wo.y(), wo.z());
  return {rgb[0], rgb[1], rgb[2]};
}

const Rgb& LinkField::emitted(uint32_t node) const {
  return scene_.materials[mesh_.patches[mesh_.node_patch[node]].material].emission;
}

LinkReceiver::LinkReceiver(const Mesh& mesh, const Links& links, const std::vector<MaterialLobes>& materials)
    : mesh_(mesh), links_(links), materials_(materials) {}

void LinkReceiver::ReadRing(const LinkField& field, std::span<const uint32_t> ring_links, int ring, int first,
                            int thinning, const LinkDirections& directions, const Frame& frame,
                            Received& work) {
  const int count = int(ring_links.size()) / thinning;
  float *red = ring_.data(), *green = red + count, *blue = green + count;
  for (int i = 0; i < count; ++i) {
    const int sector = first + i * thinning;
    const uint32_t link = ring_links[sector];
    Rgb value = Rgb::Zero();
    if (Links::IsNode(link) && !field.emission()) {
      const float* radiance = field.radiance(link);
      if (radiance[3] == 0) {
        red[i] = radiance[0];
        green[i] = radiance[1];
        blue[i] = radiance[2];
        continue;
      }
      value = field.Read(link, -frame.ToWorld(directions.Local(ring, sector)));
      ++work.lobe_reads;
    } else if (Links::IsChain(link)) {
      for (const Links::Hop* hop = links_.chain(link);; ++hop) {
        if (Links::IsNode(hop->node)) {
          Rgb radiance = Rgb::Zero();
          if (field.emission()) {
            if (hop->emission) radiance = field.emitted(hop->node);
          } else if (field.diffuse(hop->node)) {
            const float* r = field.radiance(hop->node);
            radiance = Rgb(r[0], r[1], r[2]);
          } else {
            radiance = field.Read(hop->node, UnpackDirection(hop->direction));
            ++work.lobe_reads;
          }
          value += radiance * hop->Throughput();
        }
        if (hop->last) break;
      }
    }
    red[i] = value[0];
    green[i] = value[1];
    blue[i] = value[2];
  }
}

Received LinkReceiver::Gather(uint32_t node, const LinkField& field, int thinning, float* out) {
  Received work;
  const uint32_t patch = mesh_.node_patch[node];
  const MaterialLobes& material = materials_[mesh_.patches[patch].material];
  const LinkPattern& pattern = links_.pattern(patch);
  const std::span<const uint32_t> links = links_.of(node);
  const Frame frame(mesh_.node_normal[node]);
  LinkDirections& directions = directions_.Of(pattern);
  const int count = pattern.sectors / thinning;
  const float weight = kPi / float(pattern.rings * count);
  ring_.resize(3 * size_t(pattern.sectors));
  const bool diffuse = material.diffuse();
  directions.Start(node, links_.seed());
  if (!diffuse) moments_.Start(material);

  for (int r = 0; r < pattern.rings; ++r) {
    const int first = FirstSector(r, thinning);
    ReadRing(field, links.subspan(size_t(r) * pattern.sectors, pattern.sectors), r, first, thinning,
             directions, frame, work);
    Rgb irradiance = Rgb::Zero();
    for (int c = 0; c < 3; ++c) {
      float* plane = ring_.data() + c * count;
      float sum = 0;
      for (int i = 0; i < count; ++i) {
        plane[i] *= weight;
        sum += plane[i];
      }
      irradiance[c] = sum;
    }
    work.delivered += irradiance;
    const float cosine = directions.CosTheta(r);
    if (material.sends_on()) work.mirrored += irradiance * material.SentOn(cosine);
    if (material.transmits()) work.through += irradiance * material.TransmissionAlbedo(cosine);
    if (diffuse) continue;
    work.lobe_writes += count;
    work.reflected += irradiance * material.Albedo(cosine);
    const float phi = directions.Phi(r) + 2 * kPi * float(first) / float(pattern.sectors);
    moments_.AddRing(cosine, ring_.data(), count, phi);
  }
  if (diffuse) {
    work.reflected = material.DiffuseAlbedo() * work.delivered;
    // Radiance albedo E / pi, as the coefficient of the constant function 1 / sqrt(2 pi).
    if (material.base.l_max >= 0) {
      for (int c = 0; c < 3; ++c) out[c] += work.reflected[c] * std::sqrt(2.0f / kPi);
    }
  } else {
    moments_.Finish(out, out + 3 * material.base.count());
  }
  work.absorbed = work.delivered - work.reflected - work.mirrored - work.through;
  return work;
}

}  // namespace lobe
