#ifndef ELASTIMATE_TESTS_IO_GMSH_FILES_H_
#define ELASTIMATE_TESTS_IO_GMSH_FILES_H_

#include <string>

namespace elastimate {

// Two tetrahedra on the triangle (0,0,0), (1,0,0), (0,1,0), with the tips
// (0,0,1) and (0,0,-1) and the node numbers 10, 2, 3, 5 and 7.  In ascending
// order the nodes are 2, 3, 5, 7, 10.

inline std::string GmshNodeData(const std::string& name,
                                const std::string& tip) {
  return "$NodeData\n1\n\"" + name + "\"\n1\n0\n3\n0\n3\n5\n10 0 0 0\n" +
         "2 0 0 0\n3 0 0 0\n5 " + tip + "\n7 0 0 0\n$EndNodeData\n";
}

/// The data that make a mesh a scene.
inline std::string GmshSceneData() {
  return GmshNodeData("displacement", "0.001 0.002 0.003") +
         GmshNodeData("force", "1 2 3") +
         "$NodeData\n1\n\"fixed\"\n1\n0\n3\n0\n1\n5\n10 1\n2 1\n3 1\n5 0\n"
         "7 0\n$EndNodeData\n";
}

inline std::string GmshVersion1Mesh() {
  return "$NOD\n5\n10 0 0 0\n2 1 0 0\n3 0 1 0\n5 0 0 1\n7 0 0 -1\n$ENDNOD\n"
         "$ELM\n4\n"
         "1 2 70 70 3 10 2 5\n"
         "2 2 70 70 3 5 2 3\n"
         "3 4 1 1 4 10 2 3 5\n"
         "4 4 1 1 4 10 2 3 7\n"
         "$ENDELM\n";
}

/// Two triangles make up the group "top", whatever their orientation, and an
/// inner one the group "inside".
inline std::string GmshVersion2Mesh() {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
         "$PhysicalNames\n3\n2 70 \"top\"\n2 71 \"inside\"\n3 1 \"body\"\n"
         "$EndPhysicalNames\n"
         "$Nodes\n5\n10 0 0 0\n2 1 0 0\n3 0 1 0\n5 0 0 1\n7 0 0 -1\n"
         "$EndNodes\n"
         "$Elements\n5\n"
         "1 2 2 70 1 10 2 5\n"
         "2 2 2 70 1 5 2 3\n"
         "3 2 2 71 2 10 2 3\n"
         "4 4 2 1 1 10 2 3 5\n"
         "5 4 2 1 1 10 2 3 7\n"
         "$EndElements\n";
}

inline std::string GmshVersion4Mesh() {
  return "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
         "$PhysicalNames\n2\n2 70 \"top\"\n3 1 \"body\"\n$EndPhysicalNames\n"
         "$Entities\n0 0 1 1\n"
         "1 0 0 0 1 1 1 1 70 0\n"
         "1 0 0 -1 1 1 1 1 1 0\n"
         "$EndEntities\n"
         "$Nodes\n1 5 2 10\n3 1 0 5\n10\n2\n3\n5\n7\n"
         "0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 -1\n$EndNodes\n"
         "$Elements\n2 4 1 4\n2 1 2 2\n1 10 2 5\n2 5 2 3\n"
         "3 1 4 2\n3 10 2 3 5\n4 10 2 3 7\n$EndElements\n";
}

inline std::string GmshVersion1Scene() {
  return GmshVersion1Mesh() + GmshSceneData();
}
inline std::string GmshVersion2Scene() {
  return GmshVersion2Mesh() + GmshSceneData();
}
inline std::string GmshVersion4Scene() {
  return GmshVersion4Mesh() + GmshSceneData();
}

}  // namespace elastimate

#endif  // ELASTIMATE_TESTS_IO_GMSH_FILES_H_
