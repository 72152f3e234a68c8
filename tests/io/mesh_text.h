#ifndef ELASTIMATE_TESTS_IO_MESH_TEXT_H_
#define ELASTIMATE_TESTS_IO_MESH_TEXT_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "elastimate/io/scene/mesh_reader.h"
#include "tests/io/scene_files.h"

namespace elastimate {

/// A test of files of text that describe a mesh.
class MeshTextTest : public ::testing::Test {
 protected:
  explicit MeshTextTest(std::string file_name)
      : file_name_(std::move(file_name)) {}

  MeshFile Read(const std::string& content) const {
    return ReadMeshFile(folder_.Write(file_name_, content));
  }
  std::string WhyNot(const std::string& content) const {
    try {
      Read(content);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "it is read";
  }

  const std::string file_name_;
  const TemporaryFolder folder_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_TESTS_IO_MESH_TEXT_H_
