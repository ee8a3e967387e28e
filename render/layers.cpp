#include "render/layers.h"

#include <algorithm>
#include <array>
#include <limits>

namespace lobe {
namespace {

struct Entry {
  const char* name;
  std::vector<std::string> channels;
  bool colour;
};

Entry Colours(const char* name) {
  const std::string stem = std::string(name) + ".";
  return {name, {stem + "R", stem + "G", stem + "B"}, true};
}

/// In the order of the enumeration.
const std::array<Entry, kLayerCount>& Table() {
  static const std::array<Entry, kLayerCount> table = {{Colours("albedo"),
                                                        {"N", {"N.X", "N.Y", "N.Z"}, false},
                                                        {"P", {"P.X", "P.Y", "P.Z"}, false},
                                                        {"Z", {"Z"}, false},
                                                        Colours("direct"),
                                                        Colours("indirect"),
                                                        Colours("specular"),
                                                        Colours("clamped")}};
  return table;
}

const Entry& Of(Layer layer) { return Table()[static_cast<size_t>(layer)]; }

std::string Names() {
  std::string names;
  for (const Entry& entry : Table()) names += std::string(names.empty() ? "" : ", ") + entry.name;
  return names;
}

}  // namespace

const char* LayerName(Layer layer) { return Of(layer).name; }
const std::vector<std::string>& LayerChannels(Layer layer) { return Of(layer).channels; }
bool IsColour(Layer layer) { return Of(layer).colour; }

LayerSet LayerSet::All() {
  LayerSet all;
  for (const Layer layer : kAllLayers) all.Add(layer);
  return all;
}

std::optional<LayerSet> ParseLayers(const std::string& text, std::string* wrong) {
  if (text == "all") return LayerSet::All();
  LayerSet set;
  for (size_t begin = 0;;) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const std::string name = text.substr(begin, end - begin);
    std::optional<Layer> found;
    for (const Layer layer : kAllLayers) {
      if (name == LayerName(layer)) found = layer;
    }
    if (!found) {
      *wrong = "'" + name + "' is no layer; " + Names() + " are, or all of them by 'all'";
      return std::nullopt;
    }
    if (set.Has(*found)) {
      *wrong = "'" + name + "' is given twice; each layer is expected once";
      return std::nullopt;
    }
    set.Add(*found);
    if (end == text.size()) return set;
    begin = end + 1;
  }
}

LayeredImage::LayeredImage(int width, int height, const LayerSet& wanted) : color(width, height) {
  for (const Layer layer : kAllLayers) {
    if (!wanted.Has(layer)) continue;
    Image image(width, height);
    if (layer == Layer::kDepth) {
      for (Rgb& p : image.pixels) p.setConstant(std::numeric_limits<float>::infinity());
    }
    layers.emplace(layer, std::move(image));
  }
}

}  // namespace lobe
