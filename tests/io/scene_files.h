#ifndef ELASTIMATE_TESTS_IO_SCENE_FILES_H_
#define ELASTIMATE_TESTS_IO_SCENE_FILES_H_

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>

namespace elastimate {

/// A folder that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name =
        (std::filesystem::temp_directory_path() / "elastimate-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error("no temporary folder");
    }
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& Path() const { return path_; }

  /// Writes a file of that name and gives its path.
  std::filesystem::path Write(const std::string& name,
                              const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline std::string ReadFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// `text` with the first `from` replaced, which must be there.
inline std::string Replaced(std::string text, const std::string& from,
                            const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << "no '" << from << "' in the text";
  return place == std::string::npos ? text
                                    : text.replace(place, from.size(), to);
}

/// A scene of two tetrahedra over five of six points (the third has none), with
/// a line and a triangle.
inline std::string LegacySceneText() {
  return "# vtk DataFile Version 3.0\n"
         "two tetrahedra\n"
         "ASCII\n"
         "DATASET UNSTRUCTURED_GRID\n"
         "POINTS 6 float\n"
         "0 0 0  1 0 0  9 9 9  0 1 0  0.25 0.25 1  0.25 0.25 -1\n"
         "CELLS 4 17\n"
         "2 0 1\n"
         "4 0 1 3 4\n"
         "3 0 1 3\n"
         "4 0 1 3 5\n"
         "CELL_TYPES 4\n"
         "3 10 5 10\n"
         "CELL_DATA 4\n"
         "SCALARS region int 1\n"
         "LOOKUP_TABLE default\n"
         "-5 7 -6 8\n"
         "POINT_DATA 6\n"
         "SCALARS fixed unsigned_char 1\n"
         "LOOKUP_TABLE default\n"
         "1 1 0 1 0 0\n"
         "VECTORS displacement double\n"
         "0 0 0 0 0 0 7 7 7 0 0 0 .1 .2 .3 .4 .5 .6\n"
         "FIELD FieldData 1\n"
         "force 3 6 int\n"
         "0 0 0 0 0 0 0 0 0 0 0 0 1 2 3 4 5 6\n";
}

}  // namespace elastimate

#endif  // ELASTIMATE_TESTS_IO_SCENE_FILES_H_
