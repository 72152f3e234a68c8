#ifndef ELASTIMATE_TESTS_IO_FEBIO_FILES_H_
#define ELASTIMATE_TESTS_IO_FEBIO_FILES_H_

#include <string>

namespace elastimate {

/// Two tetrahedra, each a part of its own, with a shell on top, as FEBio Studio
/// writes them.  Sets are texts in version 4, and items in version 3.
inline std::string FebioText(bool is_version_4) {
  const std::string held =
      is_version_4 ? "10,2,3" : "<n id=\"10\"/><n id=\"2\"/><n id=\"3\"/>";
  const std::string one = is_version_4 ? "11" : "<e id=\"11\"/>";
  return std::string(R"(<?xml version="1.0" encoding="ISO-8859-1"?>
<febio_spec version=")") +
         (is_version_4 ? "4.0" : "3.0") + R"(">
  <Module type="solid"/>
  <Material><material id="1" name="Material1" type="neo-Hookean"/></Material>
  <Mesh>
    <Nodes name="all">
      <node id="10">0,0,0</node>
      <node id="2">1,0,0</node>
      <node id="3">0,1,0</node>
      <node id="5">0,0,1.5</node>
      <node id="7"> 0.0, 0.0, -1.0e+0 </node>
    </Nodes>
    <Elements type="tet4" name="Upper">
      <elem id="11">10,2,3,5</elem>
    </Elements>
    <Elements type="tet4" name="Lower">
      <elem id="22">10,3,2,7</elem>
    </Elements>
    <Elements type="tri3" name="Shell">
      <elem id="33">10,3,5</elem>
    </Elements>
    <NodeSet name="held">)" +
         held + R"(</NodeSet>
    <ElementSet name="one">)" +
         one + R"(</ElementSet>
    <Surface name="top">
      <tri3 id="1">2,3,5</tri3>
    </Surface>
  </Mesh>
  <MeshDomains><SolidDomain name="Upper" mat="Material1"/></MeshDomains>
</febio_spec>
)";
}

}  // namespace elastimate

#endif  // ELASTIMATE_TESTS_IO_FEBIO_FILES_H_
