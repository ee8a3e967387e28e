#include <limits>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/report.h"
#include "app/values.h"
#include "app/view_flags.h"
#include "brdf/frame.h"
#include "render/camera_view.h"
#include "render/lobe_figures.h"
#include "render/lobe_plot.h"
#include "scene/closest_point.h"
#include "scene/glb_writer.h"
#include "scene/input_error.h"
#include "solver/trust.h"

namespace lobe {
namespace {

struct InspectFlags {
  std::string solution;
  std::optional<int64_t> node;
  std::optional<std::string> at, pixel, output;
  ViewFlags view;

  // From the flags, once checked.
  Vec3 point;
  PixelPosition position;
};

/// Everything that can be said without opening a file.
void Validate(InspectFlags* flags) {
  const int ways = int(flags->node.has_value()) + int(flags->at.has_value()) + int(flags->pixel.has_value());
  if (ways != 1) {
    throw UsageError(std::to_string(ways) +
                     " of --node, --at and --pixel are given; exactly one is expected");
  }
  if (!flags->pixel && flags->view.given()) {
    throw UsageError("--camera, --size, --eye and --fov belong to --pixel, which is missing");
  }
  flags->view.Validate();
  if (flags->at) flags->point = ParseVector("--at", *flags->at);
  if (flags->pixel) flags->position = ParsePixel("--pixel", *flags->pixel);
  if (flags->output) {
    RequireExtension("-o", *flags->output, {".glb", ".gltf", ".png", ".svg"});
    RequireOtherFile("-o", *flags->output, flags->solution, "the solution");
  }
}

/// The node that speaks loudest at a place of the mesh, hidden ones only when there is no other.
uint32_t LoudestNode(const Solution& s, const Mesh::Location& where) {
  const NodeWeights w = Interpolate(s.mesh, s.hidden, where);
  int best = 0;
  if (w.count == 0) {
    for (int i = 1; i < 3; ++i) best = where.weight[i] > where.weight[best] ? i : best;
    return s.mesh.elements[where.element][best];
  }
  for (int i = 1; i < w.count; ++i) best = w.weight[i] > w.weight[best] ? i : best;
  return w.node[best];
}

uint32_t NodeAt(const Solution& s, const Vec3& point) {
  // The nearest face that holds light; a closer one may be black on both sides.
  float nearest = std::numeric_limits<float>::infinity();
  Mesh::Location found;
  for (uint32_t f = 0; f < s.scene.faces.size(); ++f) {
    const ClosestPoint p = ClosestPointOnTriangle(point, s.scene.Corners(s.scene.faces[f]));
    if (!(p.distance < nearest)) continue;
    // Of two lit sides the one the point lies on.
    const Vec3 normal = s.scene.GeometricNormal(s.scene.faces[f]);
    const bool behind = (point - s.scene.Corners(s.scene.faces[f])[0]).dot(normal) < 0;
    for (const Side side : {behind ? Side::kBack : Side::kFront, behind ? Side::kFront : Side::kBack}) {
      const Mesh::Location where = s.mesh.Locate(f, side, p.u, p.v);
      if (where.element == kNone) continue;
      nearest = p.distance;
      found = where;
      break;
    }
  }
  if (found.element == kNone) throw InputError(s.scene.path + ": holds no nodes; nothing can be inspected");
  return LoudestNode(s, found);
}

uint32_t NodeInPixel(const Solution& s, const InspectFlags& flags) {
  const Camera camera = flags.view.ChooseCamera(s.scene);
  const PictureSize size = flags.view.ChooseSize(camera);
  const PixelPosition& p = flags.position;
  if (p.x < 0 || p.y < 0 || p.x >= size.width || p.y >= size.height) {
    throw UsageError("--pixel: " + *flags.pixel + " is outside a picture of " + std::to_string(size.width) +
                     "x" + std::to_string(size.height));
  }
  const Ray ray = CameraView(camera, size.width, size.height).EyeRay(float(p.x) + 0.5f, float(p.y) + 0.5f);
  const RayHit hit = RayTracer(s.scene).Intersect(ray);
  const std::string place = s.scene.path + ": pixel " + *flags.pixel;
  if (!hit.hit()) throw InputError(place + " looks past the scene; a pixel on a surface is expected");
  const Mesh::Location where = s.mesh.Locate(hit.face, hit.side, hit.u, hit.v);
  if (where.element == kNone) {
    throw InputError(place + " sees a side of '" + s.scene.surface_names[s.scene.faces[hit.face].surface] +
                     "' that holds no light");
  }
  return LoudestNode(s, where);
}

uint32_t ChooseNode(const Solution& s, const InspectFlags& flags) {
  if (flags.at) return NodeAt(s, flags.point);
  if (flags.pixel) return NodeInPixel(s, flags);
  if (*flags.node < 0 || uint64_t(*flags.node) >= s.mesh.node_count()) {
    throw UsageError("--node: " + std::to_string(*flags.node) +
                     " is out of range: the solution has nodes 0 to " +
                     std::to_string(int64_t(s.mesh.node_count()) - 1));
  }
  return uint32_t(*flags.node);
}

/// Base and gloss together, rows over the basis, three columns.
Eigen::MatrixXd Coefficients(const NodeLobes& lobes, uint32_t node) {
  const PartDegrees& d = lobes.degrees(node);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(CoefficientCount(std::max(0, d.max_degree())), 3);
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < d.base_count(); ++k) sum(k, c) += lobes.base(node)[c * d.base_count() + k];
    for (int k = 0; k < d.gloss_count(); ++k) sum(k, c) += lobes.gloss(node)[c * d.gloss_count() + k];
  }
  return sum;
}

struct Inspection {
  uint32_t node;
  Vec3 position;
  Frame frame;
  std::string material, surface;
  GlossKind kind;
  PartDegrees degrees;
  bool hidden;
  Side side;
  Eigen::MatrixXd coefficients;
  LobeFigures figures;
  Rgb direct_flux;
};

Inspection Inspect(const Solution& s, uint32_t node) {
  const Mesh::Patch& patch = s.mesh.patches[s.mesh.node_patch[node]];
  const Eigen::MatrixXd coefficients = Coefficients(s.total, node);
  return {node,
          s.mesh.node_position[node],
          Frame(s.mesh.node_normal[node]),
          s.scene.materials[patch.material].name,
          s.scene.surface_names[patch.surface],
          s.material_kinds[patch.material],
          s.total.degrees(node),
          s.hidden[node] != 0,
          patch.side,
          coefficients,
          MeasureLobe(coefficients),
          s.direct.Flux(node)};
}

std::string Say(const Vec3& v) { return Short(v.x()) + ", " + Short(v.y()) + ", " + Short(v.z()); }
std::string Say(const Rgb& v) { return Short(v[0]) + ", " + Short(v[1]) + ", " + Short(v[2]); }
std::string Degree(int l_max) { return l_max < 0 ? "none" : std::to_string(l_max); }

Vec3 PeakInWorld(const Inspection& i) { return i.frame.ToWorld(i.figures.peak_direction.cast<float>()); }

std::string Text(const Inspection& i) {
  const LobeFigures& f = i.figures;
  std::string text =
      "node " + std::to_string(i.node) + " on '" + i.surface + "', material '" + i.material + "', gloss " +
      Name(i.kind) + (i.hidden ? ", hidden (inside something)" : "") + "\n" + "  position  " +
      Say(i.position) + " m\n" + "  frame x   " + Say(i.frame.x) + "\n  frame y   " + Say(i.frame.y) +
      "\n  frame z   " + Say(i.frame.z) + (i.side == Side::kBack ? "  (back side)\n" : "\n") +
      "  l_max     base " + Degree(i.degrees.base) + ", gloss " + Degree(i.degrees.gloss) + "\n" +
      "  flux      " + Say(f.flux) + " W/m2, straight from lamps " + Say(i.direct_flux) + "\n" +
      "  peak      " + Say(f.peak_radiance) + " W/(m2 sr) at theta " +
      Format("%.1f", f.peak_theta_degrees()) + ", phi " + Format("%.1f", f.peak_phi_degrees()) +
      " degrees; in the world " + Say(PeakInWorld(i)) + "\n" + "  negative  " +
      Format("%.2f %% of the magnitude\n\n", 100 * f.negative_fraction);
  Table table("rrrrr");
  table.AddRow({"l", "m", "R", "G", "B"});
  for (int l = 0, k = 0; k < i.coefficients.rows(); ++l) {
    for (int m = -l; m <= l; m += 2, ++k) {
      table.AddRow({std::to_string(l), std::to_string(m), Format("%.5g", i.coefficients(k, 0)),
                    Format("%.5g", i.coefficients(k, 1)), Format("%.5g", i.coefficients(k, 2))});
    }
  }
  return text + table.Text();
}

nlohmann::json ToJsonObject(const Inspection& i) {
  const LobeFigures& f = i.figures;
  nlohmann::json coefficients = nlohmann::json::array();
  for (int k = 0; k < i.coefficients.rows(); ++k) {
    coefficients.push_back({i.coefficients(k, 0), i.coefficients(k, 1), i.coefficients(k, 2)});
  }
  return {{"node", i.node},
          {"surface", i.surface},
          {"material", i.material},
          {"kind", Name(i.kind)},
          {"side", i.side == Side::kBack ? "back" : "front"},
          {"hidden", i.hidden},
          {"position", ToJson(i.position)},
          {"frame", {{"x", ToJson(i.frame.x)}, {"y", ToJson(i.frame.y)}, {"z", ToJson(i.frame.z)}}},
          {"l_max_base", i.degrees.base < 0 ? nlohmann::json() : nlohmann::json(i.degrees.base)},
          {"l_max_gloss", i.degrees.gloss < 0 ? nlohmann::json() : nlohmann::json(i.degrees.gloss)},
          {"flux", ToJson(f.flux)},
          {"direct_flux", ToJson(i.direct_flux)},
          {"peak",
           {{"luminance", f.peak},
            {"radiance", ToJson(f.peak_radiance)},
            {"theta_degrees", f.peak_theta_degrees()},
            {"phi_degrees", f.peak_phi_degrees()},
            {"direction_local", ToJson(Vec3(f.peak_direction.cast<float>()))},
            {"direction_world", ToJson(PeakInWorld(i))}}},
          {"negative_fraction", f.negative_fraction},
          {"coefficients", coefficients}};
}

void WritePicture(const Inspection& i, const Solution& s, const std::string& path) {
  const std::string title = "node " + std::to_string(i.node) + " on '" + i.surface + "', " + i.material;
  if (Extension(path) == ".svg") {
    const std::string svg = LobeSvg(i.coefficients, title);
    WriteFileAtomically(path, {reinterpret_cast<const uint8_t*>(svg.data()), svg.size()});
  } else if (Extension(path) == ".png") {
    WriteLobePng(i.coefficients, title, path);
  } else {
    // As long as a tenth of the scene is wide: seen beside it, and not in its way.
    WriteLobeGlb(i.coefficients, i.position, i.frame.z, 0.1f * s.scene.Bounds().diagonal().norm(), path);
  }
}

ExitCode RunInspect(InspectFlags flags, Console& console) {
  Validate(&flags);
  if (flags.output) CheckWritable(*flags.output);
  const Solution solution = ReadSolution(flags.solution);
  if (const std::string sentence = TrustSentence(solution); !sentence.empty()) {
    console.Warn(flags.solution + ": " + sentence);
  }
  const Inspection inspection = Inspect(solution, ChooseNode(solution, flags));
  if (flags.output) {
    WritePicture(inspection, solution, *flags.output);
    console.Say("wrote " + *flags.output);
  }
  console.Result(Text(inspection), ToJsonObject(inspection));
  return kDone;
}

}  // namespace

void AddInspectCommand(CLI::App& app, Command* command) {
  auto flags = std::make_shared<InspectFlags>();
  CLI::App* inspect = app.add_subcommand("inspect", "Show the lobe of one node");
  inspect->footer(
      "Prints where the node is, its frame, the lobe's coefficients over the hemisphere basis, flux, peak "
      "and\n"
      "negative part, and draws the lobe: .svg and .png as polar slices and a map, .glb as a surface that "
      "stands\n"
      "on the node, to be loaded beside the solution in any glTF viewer.\n"
      "\n"
      "Examples:\n"
      "  lobe inspect solution.glb --node 1234\n"
      "  lobe inspect solution.glb --at 0.5,0,1.2 -o lobe.glb\n"
      "  lobe inspect solution.glb --camera view0 --pixel 120,80 --size 256x256 -o lobe.svg");
  inspect->add_option("SOLUTION", flags->solution, "Solution written by `lobe solve`")
      ->type_name("")
      ->required();
  inspect->add_option("--node", flags->node, "The node of this number, from 0")->type_name("N");
  inspect
      ->add_option("--at", flags->at, "The node that weighs most at the nearest point of a surface, metres")
      ->type_name("X,Y,Z");
  inspect
      ->add_option("--pixel", flags->pixel,
                   "The node that weighs most in this pixel, from 0,0 at the top left")
      ->type_name("X,Y");
  flags->view.AddTo(inspect);
  inspect->add_option("-o,--output", flags->output, "Picture of the lobe to write, .glb, .gltf, .png or .svg")
      ->type_name("FILE");
  inspect->callback(
      [flags, command] { *command = [flags](Console& console) { return RunInspect(*flags, console); }; });
}

}  // namespace lobe
