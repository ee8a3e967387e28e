// The models of brdf/ in the solver: what they reflect of a uniform room, and their data in solution files.

#include <gtest/gtest.h>

#include "solver/resume.h"
#include "solver/solution.h"
#include "solver/solver.h"
#include "tests/support/brdf_models.h"
#include "tests/support/gloss_furnace.h"
#include "tests/support/scene_builder.h"
#include "tests/support/scratch_folder.h"

namespace lobe {
namespace {

const Rgb kColour = test::kModelColour;

// One of each model; a block in a room that emits 1 shows each model's albedo in every direction.
TEST(MaterialModelsTest, BlocksShowTheirDirectionalAlbedoInAUniformRoom) {
  const Reflectance models[] = {BlinnPhong{kColour, 30},
                                CookTorrance{kColour, 0.3f},
                                OrenNayar{kColour, 0.5f},
                                AshikhminShirley{kColour, Rgb::Constant(0.05f), 30},
                                Plastic(kColour, 1.5f, 0.5f),
                                Plastic(Rgb::Constant(1), 1.5f, 0.6f),
                                test::MeasuredFrom(Ward{kColour, 0.3f}, 40, 15),
                                test::GoniometerFrom(Phong{kColour, 5}, 5)};
  for (const Reflectance& r : models) {
    const test::GlossFurnace furnace(r);
    EXPECT_GT(furnace.worst, 0) << "the block has nodes";
    // One per cent for the 512 light samples.
    EXPECT_LT(furnace.worst, furnace.stated + 0.01) << Describe(r);
  }
}

Scene PaintedBox(const std::vector<Reflectance>& models) {
  test::SceneBuilder b;
  b.AddBox({-2, -2, -2}, {2, 2, 2}, b.AddEmitter(Rgb::Constant(1)), true);
  for (size_t i = 0; i < models.size(); ++i) {
    const uint32_t paint = b.AddMaterial("paint " + std::to_string(i), models[i]);
    b.AddTriangle({-1, float(i), 0}, {1, float(i), 0.5f}, {0, float(i) + 0.5f, 0}, paint);
  }
  return b.Build();
}

TEST(MaterialModelsTest, ASolutionHoldsItsMeasuredDataAndReadsItBackBitForBit) {
  const Measured half = test::MeasuredFrom(Ward{kColour, 0.3f}, 20, 8);
  const Measured angles = test::GoniometerFrom(Phong{kColour, 5}, 15);
  const Scene scene = PaintedBox({half, angles, half});
  SolveOptions options;
  options.mesh.max_edge = 4;
  const Solution solved = Solve(scene, options);
  const test::ScratchFolder folder;
  WriteSolution(solved, folder.File("a.glb"));
  const Solution back = ReadSolution(folder.File("a.glb"));
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"a.glb"}) << "and needs no other file";
  EXPECT_EQ(DifferenceOfScenes(scene, back.scene), "");
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const auto* before = std::get_if<Measured>(&scene.materials[i].reflectance);
    if (!before) continue;
    const auto& after = *std::get<Measured>(back.scene.materials[i].reflectance).data;
    EXPECT_EQ(after.values(), before->data->values());
    EXPECT_EQ(after.axes(), before->data->axes());
    EXPECT_EQ(after.name(), before->data->name());
  }
  EXPECT_EQ(std::get<Measured>(back.scene.materials[1].reflectance).data,
            std::get<Measured>(back.scene.materials[3].reflectance).data)
      << "one copy for both";
}

// What is embedded once has two names all the same; the scene must know itself in its solution.
TEST(MaterialModelsTest, EqualDataOfTwoNamesComesBackFromASolutionThatCanBeResumed) {
  const Measured paint = test::MeasuredFrom(Ward{kColour, 0.3f}, 20, 8);
  const Scene scene = PaintedBox({paint, test::Renamed(paint, "varnish")});
  SolveOptions options;
  options.mesh.max_edge = 4;
  const test::ScratchFolder folder;
  WriteSolution(Solve(scene, options), folder.File("a.glb"));
  const Solution back = ReadSolution(folder.File("a.glb"));
  EXPECT_EQ(Describe(back.scene.materials[1].reflectance), Describe(paint));
  EXPECT_EQ(Describe(back.scene.materials[2].reflectance), "measured varnish");
  EXPECT_EQ(DifferenceOfScenes(scene, back.scene), "");
}

TEST(MaterialModelsTest, ResumingTellsOtherDataFromTheSame) {
  const Scene scene = PaintedBox({test::MeasuredFrom(Ward{kColour, 0.3f}, 20, 8)});
  EXPECT_EQ(DifferenceOfScenes(scene, PaintedBox({test::MeasuredFrom(Ward{kColour, 0.3f}, 20, 8)})), "");
  EXPECT_NE(DifferenceOfScenes(scene, PaintedBox({test::MeasuredFrom(Ward{kColour, 0.31f}, 20, 8)})), "");
}

}  // namespace
}  // namespace lobe
