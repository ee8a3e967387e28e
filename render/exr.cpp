#include "render/exr.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
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

}  // namespace

void WriteExr(const Image& image, const ExrAttributes& attributes, const std::string& path) {
  MemoryStream stream(path);
  try {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec. 709
    InsertAttributes(attributes, &header);
    Imf::FrameBuffer frame;
    const size_t stride = sizeof(Rgb);
    for (int c = 0; c < 3; ++c) {
      header.channels().insert(kChannels[c], Imf::Channel(Imf::FLOAT));
      // OpenEXR only reads from here; its interface has no const.
      char* base = const_cast<char*>(reinterpret_cast<const char*>(image.pixels.data())) + c * sizeof(float);
      frame.insert(kChannels[c], Imf::Slice(Imf::FLOAT, base, stride, stride * image.width));
    }
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw InputError(path + ": OpenEXR cannot write this picture (" + OneLine(e.what()) + ")");
  }
  WriteFileAtomically(path, stream.bytes);
}

Image ReadExr(const std::string& path) {
  return WithFile(path, [&](Imf::InputFile& file) {
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t(window.max.x) - window.min.x + 1;
    const int64_t height = int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels) {
      throw InputError(path + ": a data window of " + std::to_string(width) + " x " + std::to_string(height) +
                       " pixels; 1 to 2^28 pixels are expected");
    }
    const Imf::ChannelList& channels = file.header().channels();
    for (const char* name : kChannels) {
      if (!channels.findChannel(name)) {
        throw InputError(path + ": has no channel " + name + " (found: " + ChannelNames(channels) +
                         "); R, G and B are expected");
      }
    }
    if (!file.isComplete()) Unreadable(path, "it is incomplete: scan lines or tiles are missing");

    Image image(static_cast<int>(width), static_cast<int>(height));
    Imf::FrameBuffer frame;
    for (int c = 0; c < 3; ++c) {
      // Slice::Make finds the (virtual) address of pixel (0, 0), which lies outside for offset windows.
      frame.insert(kChannels[c], Imf::Slice::Make(Imf::FLOAT, image.pixels.data()->data() + c, window,
                                                  sizeof(Rgb), sizeof(Rgb) * size_t(width)));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return image;
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
