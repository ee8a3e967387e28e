#include "solver/link_gather.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include "brdf/frame.h"
#include "sh/hemisphere_basis.h"

namespace lobe {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Which sector of a ring a thinned sweep starts with: rings next to each other start apart.
int FirstSector(int ring, int thinning) { return thinning == 1 ? 0 : (5 * ring) % thinning; }

}  // namespace

LinkField::LinkField(const Scene& scene, const Mesh& mesh) : scene_(scene), mesh_(mesh) {}

LinkField::LinkField(const Scene& scene, const Mesh& mesh, const NodeLobes& lobes,
                     const std::vector<uint8_t>& degrees)
    : scene_(scene), mesh_(mesh), emission_(false), radiance_(mesh.node_count()) {
  const auto degree = [&](uint32_t n, int own) {
    return degrees.empty() ? own : std::min<int>(own, degrees[n]);
  };
  std::map<std::pair<int, int>, DegreeCut> cuts;
  if (lobes.max_degree() > 0) {
    size_t packed = 0;
    reader_.resize(mesh.node_count());
    packed_begin_.resize(mesh.node_count());
    for (uint32_t n = 0; n < mesh.node_count(); ++n) {
      const PartDegrees& d = lobes.degrees(n);
      const int sent = degree(n, d.max_degree());
      for (const int own : {d.base, d.gloss}) {
        if (own > sent) cuts.try_emplace({own, sent}, own, sent);
      }
      if (sent <= 0) continue;
      reader_[n] = &readers_.try_emplace(sent, sent).first->second;
      packed_begin_[n] = packed;
      packed += reader_[n]->packed_size();
    }
    packed_.resize(packed, 0.0f);
  }
  const float scale = 1.0f / std::sqrt(2.0f * kPi);
  tbb::parallel_for(uint32_t(0), uint32_t(mesh.node_count()), [&](uint32_t n) {
    const PartDegrees& d = lobes.degrees(n);
    radiance_[n] = {0, 0, 0, 0};
    if (d.diffuse()) {
      const float* base = lobes.base(n);
      if (d.base >= 0) radiance_[n] = {base[0] * scale, base[1] * scale, base[2] * scale, 0};
      return;
    }
    const auto all = lobes.all(n);
    if (std::all_of(all.begin(), all.end(), [](float v) { return v == 0; })) return;
    const LobeReader* reader = reader_[n];
    radiance_[n][3] = reader != nullptr;
    thread_local std::vector<float> cut;
    const auto add = [&](const float* part, int own) {
      if (own < 0) return;
      const int sent = degree(n, own);
      if (sent < own) {
        cut.resize(3 * size_t(CoefficientCount(sent)));
        const DegreeCut& lower = cuts.at({own, sent});
        for (int c = 0; c < 3; ++c) {
          lower.Apply(part + c * CoefficientCount(own), cut.data() + c * CoefficientCount(sent));
        }
        part = cut.data();
      }
      if (reader) {
        reader->Pack(part, sent, packed_.data() + packed_begin_[n]);
      } else {
        for (int c = 0; c < 3; ++c) radiance_[n][c] += part[c] * scale;
      }
    };
    add(lobes.base(n), d.base);
    add(lobes.gloss(n), d.gloss);
  });
}

Rgb LinkField::Read(uint32_t node, const Vec3& wo_world) const {
  const Vec3 wo = Frame(mesh_.node_normal[node]).ToLocal(wo_world);
  if (wo.z() < 0) return Rgb::Zero();
  const auto rgb = reader_[node]->Read(packed_.data() + packed_begin_[node], wo.x(), wo.y(), wo.z());
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
