// pliant model build, info, export.
#include "drivers/geometry_files/geometry.hpp"
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

using ModelCommand = CommandTest;

TEST_F(ModelCommand, BuildsFromTheSimulatedObject) {
  const Ended built = run_pliant({"model", "build", "simulated:cushion", "-o", at("c.model")});
  EXPECT_EQ(built.code, 0) << built.err;
  EXPECT_EQ(built.err, "");
  EXPECT_NE(built.out.find("points: "), std::string::npos) << built.out;
  EXPECT_NE(built.out.find("keypoints: "), std::string::npos);
  EXPECT_NE(built.out.find("bytes: "), std::string::npos);
  EXPECT_NE(built.out.find("characterisable: yes"), std::string::npos) << built.out;
  EXPECT_NE(built.out.find("links across the body: "), std::string::npos) << built.out;
  EXPECT_NE(built.out.find("material: 0.5 "), std::string::npos) << built.out;

  const Ended info = run_pliant({"model", "info", at("c.model")});
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_NE(info.out.find("640x480"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("coverage: 100 %"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("expected detection: "), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("workspace"), std::string::npos);
}

TEST_F(ModelCommand, ExportsPointsAndNormals) {
  const std::string model = box_model();
  ASSERT_EQ(run_pliant({"model", "export", model, "-o", at("points.ply")}).code, 0);
  const Result<Geometry> points = read_geometry(at("points.ply"));
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_GT(points->vertices.size(), 500U);
  EXPECT_EQ(points->normals.size(), points->vertices.size());
}

TEST_F(ModelCommand, BuildingTwiceGivesTheSameBytes) {
  ASSERT_EQ(run_pliant({"model", "build", "simulated:box", "-o", at("a.model")}).code, 0);
  ASSERT_EQ(run_pliant({"model", "build", "simulated:box", "-o", at("b.model")}).code, 0);
  EXPECT_EQ(read_file(at("a.model")), read_file(at("b.model")));
}

TEST_F(ModelCommand, TheMaterialIsKeptInTheFile) {
  ASSERT_EQ(run_pliant({"model", "build", "simulated:box", "-o", at("m"), "--material", "0.25"}).code, 0);
  const Ended info = run_pliant({"model", "info", at("m")});
  EXPECT_NE(info.out.find("material: 0.25 "), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("links along the surface: "), std::string::npos) << info.out;
  const Ended refused = run_pliant({"model", "build", "simulated:box", "-o", at("n"), "--material", "1.5"});
  EXPECT_EQ(refused.code, 2) << refused.err;
  EXPECT_NE(refused.err.find("--material"), std::string::npos) << refused.err;
}

TEST_F(ModelCommand, AFlatPlateIsWrittenAndCalledNotCharacterisable) {
  write_file(at("plate.obj"), "v 0 0 0\nv 0.3 0 0\nv 0.3 0.2 0\nv 0 0.2 0\nf 1 2 3 4\n");
  const Ended built = run_pliant({"model", "build", at("plate.obj"), "-o", at("plate.model")});
  EXPECT_EQ(built.code, 0) << built.err;
  EXPECT_NE(built.out.find("characterisable: no"), std::string::npos) << built.out;
  EXPECT_TRUE(std::filesystem::exists(at("plate.model")));
}

TEST_F(ModelCommand, WrongUnitsAreWarnedOf) {
  write_file(at("big.obj"),
             "v 0 0 0\nv 300 0 0\nv 300 200 0\nv 0 0 150\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const Ended built = run_pliant({"model", "build", at("big.obj"), "-o", at("big.model")});
  EXPECT_NE(built.err.find("--units mm"), std::string::npos) << built.err;
  const Ended right = run_pliant({"model", "build", at("big.obj"), "-o", at("big.model"), "--units", "mm"});
  EXPECT_EQ(right.code, 0) << right.err;
  EXPECT_EQ(right.err, "");
}

TEST_F(ModelCommand, AWrongUnitDoesNotCostTheModelThatIsThere) {
  // 29 mm in metres, read as millimetres.
  write_file(at("small.obj"),
             "v 0 0 0\nv 0.029 0 0\nv 0.029 0.02 0\nv 0 0 0.015\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const std::string model = box_model(), before = read_file(model);
  expect_refused(run_pliant({"model", "build", at("small.obj"), "--units", "mm", "-o", model}), 2,
                 {"small.obj", "mm across", "without --units mm"});
  EXPECT_EQ(read_file(model), before);
  EXPECT_EQ(run_pliant({"model", "build", at("small.obj"), "-o", model}).code, 0);
}

TEST_F(ModelCommand, BadInputsAreRefused) {
  expect_refused(run_pliant({"model", "build", at("none.ply"), "-o", at("m")}), 2, {"none.ply"});
  expect_refused(run_pliant({"model", "build", folder_.string(), "-o", at("m")}), 2, {});
  write_file(at("empty.ply"), "");
  expect_refused(run_pliant({"model", "build", at("empty.ply"), "-o", at("m")}), 2, {"empty.ply"});
  write_file(at("cut.ply"),
             "ply\nformat binary_little_endian 1.0\nelement vertex 1000\nproperty float x\nproperty float y\n"
             "property float z\nend_header\nabc");
  expect_refused(run_pliant({"model", "build", at("cut.ply"), "-o", at("m")}), 2, {"cut.ply"});
  write_file(at("one.obj"), "v 0 0 0\n");
  expect_refused(run_pliant({"model", "build", at("one.obj"), "-o", at("m")}), 2, {"one.obj"});
  expect_refused(run_pliant({"model", "build", "simulated:teapot", "-o", at("m")}), 2, {"teapot"});
  EXPECT_FALSE(std::filesystem::exists(at("m")));
}

TEST_F(ModelCommand, AnUnwritableOutputIsAWriteFailure) {
  expect_refused(run_pliant({"model", "build", "simulated:box", "-o", at("no/such/folder/m")}), 3,
                 {"folder/m"});
  const std::string model = box_model();
  expect_refused(run_pliant({"model", "export", model, "-o", at("no/such/folder/p.ply")}), 3, {"p.ply"});
}

TEST_F(ModelCommand, DamagedModelFilesAreRefused) {
  const std::string whole = read_file(box_model());
  expect_refused(run_pliant({"model", "info", at("none.model")}), 2, {"none.model"});
  write_file(at("d.model"), whole.substr(0, whole.size() / 2));
  expect_refused(run_pliant({"model", "info", at("d.model")}), 2, {"d.model", "cut short"});
  write_file(at("d.model"), whole.substr(0, 20));
  expect_refused(run_pliant({"model", "info", at("d.model")}), 2, {"d.model"});
  std::string corrupt = whole;
  corrupt[whole.size() / 2] = static_cast<char>(corrupt[whole.size() / 2] ^ 1);
  write_file(at("d.model"), corrupt);
  expect_refused(run_pliant({"model", "info", at("d.model")}), 2, {"d.model", "corrupt"});
  std::string newer = whole;
  newer[12] = 99;
  write_file(at("d.model"), newer);
  expect_refused(run_pliant({"model", "info", at("d.model")}), 2, {"newer"});
  std::string older = whole;
  older[12] = 2;
  write_file(at("d.model"), older);
  expect_refused(run_pliant({"model", "info", at("d.model")}), 2, {"older", "build it again"});
  write_file(at("d.model"), "ply\nformat ascii 1.0\nend_header\n");
  expect_refused(run_pliant({"model", "info", at("d.model")}), 2, {"not a model"});
}

}  // namespace
}  // namespace pliant::test
