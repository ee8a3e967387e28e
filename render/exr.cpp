#include "render/exr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <list>
#include <stdexcept>
#include <type_traits>

#include <ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTestFile.h>

#include "scene/glb_writer.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

static_assert(sizeof(Rgb) == 3 * sizeof(float), "OpenEXR writes straight into Image::pixels");

constexpr const char* kChannels[3] = {"R", "G", "B"};
/// A window beyond this is taken for a broken header: 2^28 pixels (chosen), 16384 x 16384.
constexpr int64_t kMaxPixels = int64_t(1) << 28;

/// OpenEXR writes here, and the bytes reach the disk in one atomic step.
class MemoryStream : public Imf::OStream {
 public:
  explicit MemoryStream(const std::string& name) : OStream(name.c_str()) {}
  void write(const char c[], int n) override {
    if (position_ + n > bytes.size()) bytes.resize(position_ + n);
    std::memcpy(bytes.data() + position_, c, n);
    position_ += n;
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }

  std::vector<uint8_t> bytes;

 private:
  uint64_t position_ = 0;
};

/// OpenEXR's words, as part of one sentence of ours.
std::string OneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  return text;
}

[[noreturn]] void Unreadable(const std::string& path, const std::string& why) {
  throw InputError(path + ": not a readable OpenEXR picture (" + OneLine(why) + ")");
}

/// Opens, runs `read(file)`, and turns whatever OpenEXR throws into one sentence.
template <typename Read>
auto WithFile(const std::string& path, Read read) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw InputError(path + ": no such file; an OpenEXR picture is expected");
  }
  if (std::filesystem::is_directory(path, error)) {
    throw InputError(path + ": is a directory; an OpenEXR picture is expected");
  }
  if (!Imf::isOpenExrFile(path.c_str())) Unreadable(path, "it does not begin with the OpenEXR magic number");
  try {
    Imf::InputFile file(path.c_str());
    return read(file);
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    Unreadable(path, e.what());
  }
}

std::string ChannelNames(const Imf::ChannelList& channels) {
  std::string names;
  for (auto i = channels.begin(); i != channels.end(); ++i) {
    if (!names.empty()) names += ", ";
    names += i.name();
  }
  return names.empty() ? "none" : names;
}

void InsertAttributes(const ExrAttributes& attributes, Imf::Header* header) {
  for (const auto& [name, value] : attributes) {
    if (const auto* text = std::get_if<std::string>(&value)) {
      header->insert(name, Imf::StringAttribute(*text));
    } else if (const auto* number = std::get_if<float>(&value)) {
      header->insert(name, Imf::FloatAttribute(*number));
    } else if (const auto* integer = std::get_if<int>(&value)) {
      header->insert(name, Imf::IntAttribute(*integer));
    } else {
      const auto& list = std::get<std::vector<float>>(value);
      if (list.size() == 16) {
        Imath::M44f m;
        std::copy(list.begin(), list.end(), m.getValue());
        header->insert(name, Imf::M44fAttribute(m));
      } else {
        header->insert(name, Imf::FloatVectorAttribute(list));
      }
    }
  }
}

/// Channels on their way into a file; keeps what had to be converted.
class OutgoingChannels {
 public:
  OutgoingChannels(const Imath::Box2i& window, Imf::Header* header) : window_(window), header_(header) {}

  void AddFloat(const std::string& name, const float* values, size_t stride) {
    header_->channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame_.insert(name, Imf::Slice::Make(Imf::FLOAT, values, window_, stride, stride * RowLength()));
  }
  void AddDepth(const std::string& name, const Image& image) {
    std::vector<float>& plane = floats_.emplace_back();
    for (const Rgb& p : image.pixels) plane.push_back(std::isinf(p[0]) ? kBackgroundDepth : p[0]);
    AddFloat(name, plane.data(), sizeof(float));
  }
  void AddHalf(const std::string& name, const Image& image, int channel) {
    std::vector<half>& plane = halves_.emplace_back();
    for (const Rgb& p : image.pixels) {
      if (std::abs(p[channel]) > kHalfMax) ++clamped_;
      // NaN passes through: what went wrong should be seen.
      plane.push_back(
          half(std::isnan(p[channel]) ? p[channel] : std::clamp(p[channel], -kHalfMax, kHalfMax)));
    }
    header_->channels().insert(name, Imf::Channel(Imf::HALF));
    frame_.insert(
        name, Imf::Slice::Make(Imf::HALF, plane.data(), window_, sizeof(half), sizeof(half) * RowLength()));
  }
  /// Three channels of an image.
  void AddImage(const std::vector<std::string>& names, const Image& image, bool as_half) {
    for (int c = 0; c < 3; ++c) {
      if (as_half) {
        AddHalf(names[c], image, c);
      } else {
        AddFloat(names[c], image.pixels.data()->data() + c, sizeof(Rgb));
      }
    }
  }

  const Imf::FrameBuffer& frame() const { return frame_; }
  size_t clamped() const { return clamped_; }

 private:
  size_t RowLength() const { return size_t(window_.max.x - window_.min.x + 1); }

  Imath::Box2i window_;
  Imf::Header* header_;
  Imf::FrameBuffer frame_;
  // Slices point into these; a list's elements stay where they are.
  std::list<std::vector<float>> floats_;
  std::list<std::vector<half>> halves_;
  size_t clamped_ = 0;
};

void RequireFit(const LayeredImage& image, const ExrOptions& o) {
  const Image& color = image.color;
  bool fits = color.width > 0 && color.height > 0;
  for (const auto& [layer, values] : image.layers) {
    fits = fits && values.width == color.width && values.height == color.height;
  }
  if (o.full_width != 0 || o.full_height != 0) {
    fits = fits && o.left >= 0 && o.top >= 0 && o.left + color.width <= o.full_width &&
           o.top + color.height <= o.full_height;
  }
  if (!fits) throw std::invalid_argument("WriteExr: sizes of colours, layers and windows do not fit");
}

/// The data window's size; refuses what is no picture, before memory is asked for.
std::pair<int, int> SizeOf(const Imf::InputFile& file, const std::string& path) {
  const Imath::Box2i window = file.header().dataWindow();
  const int64_t width = int64_t(window.max.x) - window.min.x + 1;
  const int64_t height = int64_t(window.max.y) - window.min.y + 1;
  if (width < 1 || height < 1 || width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels) {
    throw InputError(path + ": a data window of " + std::to_string(width) + " x " + std::to_string(height) +
                     " pixels; 1 to 2^28 pixels are expected");
  }
  return {int(width), int(height)};
}

/// Three channels, all of which there are; the same one may be asked for three times.
Image ReadChannels(Imf::InputFile& file, const std::array<std::string, 3>& names, const std::string& path) {
  const auto [width, height] = SizeOf(file, path);
  if (!file.isComplete()) Unreadable(path, "it is incomplete: scan lines or tiles are missing");
  const Imath::Box2i window = file.header().dataWindow();
  Image image(width, height);
  Imf::FrameBuffer frame;
  for (int c = 0; c < 3; ++c) {
    // Slice::Make finds the (virtual) address of pixel (0, 0), which lies outside for offset windows.
    frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, image.pixels.data()->data() + c, window, sizeof(Rgb),
                                            sizeof(Rgb) * size_t(width)));
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  if (names[0] == names[2]) {  // OpenEXR filled the last of them only
    for (Rgb& p : image.pixels) p.setConstant(p[2]);
  }
  return image;
}

std::array<std::string, 3> Triple(const std::string& layer, const char* letters) {
  std::array<std::string, 3> names;
  for (int c = 0; c < 3; ++c) names[c] = layer + "." + letters[c];
  return names;
}

bool HasAll(const Imf::ChannelList& channels, const std::array<std::string, 3>& names) {
  return std::all_of(names.begin(), names.end(),
                     [&](const std::string& name) { return channels.findChannel(name) != nullptr; });
}

std::vector<std::string> LayersIn(const Imf::ChannelList& channels) {
  std::vector<std::string> found;
  for (auto i = channels.begin(); i != channels.end(); ++i) {
    const std::string name = i.name();
    const size_t dot = name.rfind('.');
    const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
    if (dot == std::string::npos && (last == "R" || last == "G" || last == "B" || last == "A")) continue;
    std::string layer = name;
    if (dot != std::string::npos) {
      const std::string stem = name.substr(0, dot);
      const bool rgb = HasAll(channels, Triple(stem, "RGB")), xyz = HasAll(channels, Triple(stem, "XYZ"));
      if (rgb && last == "A") continue;
      if ((rgb && std::strchr("RGB", last[0])) || (!rgb && xyz && std::strchr("XYZ", last[0]))) layer = stem;
    }
    if (std::find(found.begin(), found.end(), layer) == found.end()) found.push_back(layer);
  }
  return found;
}

PixelRect ToRect(const Imath::Box2i& box) { return {box.min.x, box.min.y, box.max.x + 1, box.max.y + 1}; }

}  // namespace

ExrReport WriteExr(const LayeredImage& image, const ExrAttributes& attributes, const ExrOptions& options,
                   const std::string& path) {
  RequireFit(image, options);
  MemoryStream stream(path);
  ExrReport report;
  try {
    const int width = image.color.width, height = image.color.height;
    const Imath::Box2i data({options.left, options.top},
                            {options.left + width - 1, options.top + height - 1});
    const Imath::Box2i display = options.full_width > 0
                                     ? Imath::Box2i({0, 0}, {options.full_width - 1, options.full_height - 1})
                                     : data;
    Imf::Header header(display, data);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec. 709
    InsertAttributes(attributes, &header);
    OutgoingChannels channels(data, &header);
    channels.AddImage({"R", "G", "B"}, image.color, options.half_colours);
    for (const auto& [layer, values] : image.layers) {
      if (layer == Layer::kDepth) {
        channels.AddDepth(LayerChannels(layer)[0], values);
      } else {
        channels.AddImage(LayerChannels(layer), values, options.half_colours && IsColour(layer));
      }
    }
    report.clamped = channels.clamped();
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(channels.frame());
    file.writePixels(height);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw InputError(path + ": OpenEXR cannot write this picture (" + OneLine(e.what()) + ")");
  }
  WriteFileAtomically(path, stream.bytes);
  return report;
}

void WriteExr(const Image& image, const ExrAttributes& attributes, const std::string& path) {
  LayeredImage layered;
  layered.color = image;
  WriteExr(layered, attributes, {}, path);
}

Image ReadExr(const std::string& path) {
  return WithFile(path, [&](Imf::InputFile& file) {
    SizeOf(file, path);
    const Imf::ChannelList& channels = file.header().channels();
    for (const char* name : kChannels) {
      if (!channels.findChannel(name)) {
        throw InputError(path + ": has no channel " + name + " (found: " + ChannelNames(channels) +
                         "); R, G and B are expected");
      }
    }
    return ReadChannels(file, {kChannels[0], kChannels[1], kChannels[2]}, path);
  });
}

std::vector<std::string> ListExrLayers(const std::string& path) {
  return WithFile(path, [](Imf::InputFile& file) { return LayersIn(file.header().channels()); });
}

ExrLayer ReadExrLayer(const std::string& path, const std::string& name) {
  return WithFile(path, [&](Imf::InputFile& file) -> ExrLayer {
    const Imf::ChannelList& channels = file.header().channels();
    const auto rgb = Triple(name, "RGB"), xyz = Triple(name, "XYZ");
    if (HasAll(channels, rgb)) return {ReadChannels(file, rgb, path), true};
    if (HasAll(channels, xyz)) return {ReadChannels(file, xyz, path), false};
    if (channels.findChannel(name)) return {ReadChannels(file, {name, name, name}, path), false};
    std::string found;
    for (const std::string& layer : LayersIn(channels)) found += (found.empty() ? "" : ", ") + layer;
    throw InputError(path + ": has no layer '" + name + "'; found: " + (found.empty() ? "none" : found));
  });
}

ExrWindows ReadExrWindows(const std::string& path) {
  return WithFile(path, [](Imf::InputFile& file) -> ExrWindows {
    return {ToRect(file.header().dataWindow()), ToRect(file.header().displayWindow())};
  });
}

ExrAttributes ReadExrAttributes(const std::string& path) {
  return WithFile(path, [](Imf::InputFile& file) {
    ExrAttributes found;
    const Imf::Header& header = file.header();
    for (auto i = header.begin(); i != header.end(); ++i) {
      const Imf::Attribute& a = i.attribute();
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a)) {
        found[i.name()] = text->value();
      } else if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&a)) {
        found[i.name()] = number->value();
      } else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&a)) {
        found[i.name()] = integer->value();
      } else if (const auto* m = dynamic_cast<const Imf::M44fAttribute*>(&a)) {
        const float* v = m->value().getValue();
        found[i.name()] = std::vector<float>(v, v + 16);
      } else if (const auto* list = dynamic_cast<const Imf::FloatVectorAttribute*>(&a)) {
        found[i.name()] = list->value();
      }
    }
    return found;
  });
}

}  // namespace lobe
