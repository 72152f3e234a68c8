#include <elastimate/io/examples/example_scenes.h>
#include <elastimate/io/report/report.h>

#include <iostream>

int main() {
  std::cout << elastimate::JsonReport({}, elastimate::CuboidScene({}), {}, {},
                                      {});
  return 0;
}
