# The packages behind each component; read by the build and by the installed package, so that both find the same.
#
# ELASTIMATE_COMPONENTS chooses among core, estimators, io and petsc (default: all).

include(CMakeFindDependencyMacro)

if(NOT ELASTIMATE_COMPONENTS)
  set(ELASTIMATE_COMPONENTS core estimators io petsc)
endif()

# OpenBLAS comes before everything that links a BLAS of its own choice: the first dgemm_ found is the one CHOLMOD runs.
find_dependency(Eigen3 3.4)
find_dependency(OpenBLAS)
find_dependency(CHOLMOD)
find_dependency(hwy 1.0)
find_dependency(nanoflann 1.4)
find_dependency(OpenMP COMPONENTS CXX)
find_dependency(Boost 1.74)

if("estimators" IN_LIST ELASTIMATE_COMPONENTS OR "io" IN_LIST ELASTIMATE_COMPONENTS)
  find_dependency(Ceres 2.1)
  # Debian's Ceres names ATLAS in its link interface, although the shared library needs nothing more from its users;
  # left there, ATLAS's dgemm_ can come before OpenBLAS's.
  get_target_property(_elastimate_ceres_libraries Ceres::ceres INTERFACE_LINK_LIBRARIES)
  list(FILTER _elastimate_ceres_libraries EXCLUDE REGEX "/lib(lapack|blas|f77blas|atlas|cblas)\\.(so|a)$")
  set_target_properties(Ceres::ceres PROPERTIES INTERFACE_LINK_LIBRARIES "${_elastimate_ceres_libraries}")
  unset(_elastimate_ceres_libraries)
endif()

if("io" IN_LIST ELASTIMATE_COMPONENTS)
  find_dependency(VTK 9.1 COMPONENTS CommonCore CommonDataModel CommonExecutionModel FiltersCore IOCore IOXML IOXMLParser)
  find_dependency(nlohmann_json 3.9)
  find_dependency(pugixml 1.10)
  find_dependency(LibCSV)
  find_dependency(Threads)
endif()
