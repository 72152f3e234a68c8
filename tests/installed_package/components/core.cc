#include <elastimate/core/package/version.h>
#include <elastimate/core/scene/scene_builder.h>

#include <iostream>

int main() {
  const double coordinates[] = {0, 0, 1, 0, 0, 1};
  const int connectivity[] = {0, 1, 2};
  const elastimate::Mesh mesh = elastimate::MakeMesh(
      elastimate::ElementKind::kTri3, coordinates, 3, connectivity, 1);
  std::cout << elastimate::Version() << " " << ElementVolumes(mesh) << "\n";
  return ELASTIMATE_VERSION == elastimate::Version() ? 0 : 1;
}
