#include "drivers/model_files/model_file.hpp"

#include "drivers/model_files/describe_model.hpp"
#include "tests/geometry_files/bytes.hpp"
#include "tests/model_files/built.hpp"
#include "tests/model_files/shapes.hpp"

namespace pliant {
namespace {

using namespace testing;

TEST(ModelFile, IsReadAsWrittenAndMoves) {
  const TemporaryFolder folder;
  const Made made = make(shapes::cushion_with_knob(), {1, 0.02});
  ASSERT_TRUE(write_model(folder / "a.model", made.built.image));
  EXPECT_EQ(folder.count(), 1U);
  Result<ModelFile> opened = ModelFile::open(folder / "a.model");
  ASSERT_TRUE(opened) << opened.error().message;
  ModelFile first = std::move(*opened);
  ModelFile second;
  second = std::move(first);
  EXPECT_TRUE(first.view().empty());  // NOLINT(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
  ASSERT_EQ(second.image().size(), made.built.image.size());
  EXPECT_EQ(std::memcmp(second.image().data(), made.built.image.data(), made.built.image.size()), 0);
  EXPECT_EQ(second.view().size(), made.view().size());
  second = std::move(*ModelFile::open(folder / "a.model"));
  EXPECT_EQ(second.view().size(), made.view().size());
}

TEST(ModelFile, StaysAsCheckedWhenItsFileIsOverwritten) {
  const TemporaryFolder folder;
  const Made made = make(shapes::cushion_with_knob(), {1, 0.02});
  ASSERT_TRUE(write_model(folder / "a.model", made.built.image));
  const Result<ModelFile> model = ModelFile::open(folder / "a.model");
  ASSERT_TRUE(model) << model.error().message;
  // In place, as cp does, and shorter.
  put(folder / "a.model", "no model");
  ASSERT_EQ(model->image().size(), made.built.image.size());
  EXPECT_EQ(std::memcmp(model->image().data(), made.built.image.data(), made.built.image.size()), 0);
}

TEST(ModelFile, ErrorsAreOneLineWithTheFilesNameAndTheMend) {
  const TemporaryFolder folder;
  const std::string whole(static_cast<const char*>(static_cast<const void*>(
                              make(shapes::box(0.1, 0.1, 0.2), {1, 0.01}).built.image.data())),
                          2048);
  const auto error = [&](const std::string& name) {
    const Result<ModelFile> model = ModelFile::open(folder / name);
    EXPECT_FALSE(model);
    if (model) return std::string();
    EXPECT_EQ(model.error().kind, ErrorKind::bad_input);
    EXPECT_EQ(model.error().message.rfind((folder / name).string() + ": ", 0), 0U);
    EXPECT_FALSE(mentions(model.error().message, "\n"));
    return model.error().message;
  };
  EXPECT_TRUE(mentions(error("missing.model"), "No such file"));
  EXPECT_TRUE(mentions(error(""), "folder"));
  put(folder / "empty.model", "");
  EXPECT_TRUE(mentions(error("empty.model"), "too short"));
  put(folder / "short.model", whole);
  EXPECT_TRUE(mentions(error("short.model"), "cut short"));
  put(folder / "mesh.model", "ply\nformat ascii 1.0\n");
  EXPECT_TRUE(mentions(error("mesh.model"), "pliant model build"));
  put(folder / "huge.model", whole);
  std::filesystem::resize_file(folder / "huge.model", std::uintmax_t{1} << 40);
  EXPECT_TRUE(mentions(error("huge.model"), "corrupt"));
}

TEST(ModelFile, AFailedWriteIsAWriteError) {
  const TemporaryFolder folder;
  const Outcome written = write_model(folder / "none" / "a.model", bytes_of("data"));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::write);
  EXPECT_EQ(folder.count(), 0U);
}

TEST(DescribeModel, NamesWhatIsInIt) {
  const Made made = make(shapes::box(0.1, 0.1, 0.2), {1, 0.01});
  const std::string text = describe_model(made.view());
  EXPECT_TRUE(mentions(text, "points: " + std::to_string(made.view().size()) + "\n"));
  EXPECT_TRUE(mentions(text, "extent: 100.0 x 100.0 x 200.0 mm\n"));
  EXPECT_TRUE(mentions(text, "surface: closed\n"));
  EXPECT_TRUE(mentions(text, "patches: " + std::to_string(made.view().patches().size()) + ", "));
  EXPECT_TRUE(mentions(
      text, "links along the surface: " + std::to_string(made.view().surface_links().size()) + ", "));
  EXPECT_TRUE(
      mentions(text, "links across the body: " + std::to_string(made.view().body_links().size()) + ", "));
  EXPECT_TRUE(mentions(text, "material: 0.5 "));
  EXPECT_TRUE(mentions(describe_model(make(shapes::plane(0.2, 0.1, 60)).view()), "across the body: none\n"));
}

}  // namespace
}  // namespace pliant
