#include <elastimate/estimators/registry.h>

#include <iostream>

int main() {
  std::cout << elastimate::MakeEstimator("auto")->Name() << "\n";
  return 0;
}
