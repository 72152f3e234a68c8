# How the project's libraries, programs and package are made.

# In the build tree as in an installed one, headers are included as "elastimate/<folder>/<header>.h".
function(elastimate_prepare_include_directory)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include/elastimate)
  foreach(folder ${ARGN})
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${PROJECT_BINARY_DIR}/include/elastimate/${folder} SYMBOLIC)
  endforeach()
endfunction()

# Sets the variable of the name of a macro of Eigen to its value under the flags of the build, a number of bytes.
function(elastimate_read_alignment_of_eigen macro)
  include(CheckCXXSourceCompiles)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" configuration)
  string(MD5 flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${configuration}}")
  set(CMAKE_REQUIRED_LIBRARIES Eigen3::Eigen)
  set(CMAKE_REQUIRED_QUIET ON)
  set(CMAKE_TRY_COMPILE_CONFIGURATION ${CMAKE_BUILD_TYPE})
  set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
  foreach(bytes 16 32 64 0)
    set(result ELASTIMATE_${macro}_IS_${bytes}_${flags})
    check_cxx_source_compiles("#include <Eigen/Core>\nstatic_assert(${macro} == ${bytes}, \"\");" ${result})
    if(${result})
      set(${macro} ${bytes} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "${macro} of Eigen is none of 16, 32, 64 and 0 with the flags '${CMAKE_CXX_FLAGS}'")
endfunction()

# Writes the header that tells sources how the libraries were built (cmake/build_settings.h.in).
function(elastimate_write_build_settings)
  elastimate_read_alignment_of_eigen(EIGEN_DEFAULT_ALIGN_BYTES)
  elastimate_read_alignment_of_eigen(EIGEN_MAX_STATIC_ALIGN_BYTES)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/build_settings.h.in
                 ${PROJECT_BINARY_DIR}/include/elastimate/generated/build_settings.h @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/include/elastimate/generated/build_settings.h
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/elastimate/generated)
endfunction()

# Warnings are errors in the project's own sources only.  What is linked into a program stays hidden in it: else the
# program's instances of Eigen's templates stand in for those within other libraries, which may have been built with
# another allocator.
function(elastimate_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Werror)
  # Where OpenMP is on, as in core, Eigen's threads spin while they wait for each other: ten times slower beside other
  # programs.  The same instances of its templates serve all libraries.
  target_compile_definitions(${target} PRIVATE EIGEN_DONT_PARALLELIZE)
  elastimate_unite_folders(${target})
  get_target_property(type ${target} TYPE)
  if(NOT type STREQUAL SHARED_LIBRARY)
    set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  endif()
endfunction()

# Of Eigen, and further ones: they take longer to read than most sources to compile.
function(elastimate_precompile_headers target)
  target_precompile_headers(${target} PRIVATE <Eigen/Core> <Eigen/Geometry> <Eigen/SparseCore> ${ARGN})
endfunction()

# With CMAKE_UNITY_BUILD, the sources of a folder are compiled as one: the instances of Eigen's templates that each of
# them would have are made once.
function(elastimate_unite_folders target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    cmake_path(GET source PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "sources_${folder}" group)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()

# elastimate_add_library(<component> SOURCES ... PUBLIC_HEADERS ... PUBLIC <libraries> PRIVATE <libraries>)
function(elastimate_add_library component)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC_HEADERS;PUBLIC;PRIVATE" ${ARGN})
  set(target elastimate_${component})
  add_library(${target} ${ARG_SOURCES})
  add_library(elastimate::${component} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${component} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL SHARED_LIBRARY)
    set_target_properties(${target} PROPERTIES VERSION ${PROJECT_VERSION}
                                               SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
                                               LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/elastimate.map)
    target_link_options(${target} PRIVATE LINKER:--version-script=${PROJECT_SOURCE_DIR}/cmake/elastimate.map)
  else()
    # Where the modules and helper programs are, wherever the package is installed (core/package/package_file.h).
    target_link_options(${target} INTERFACE
                        $<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${ELASTIMATE_PACKAGE_FILES}>)
  endif()
  target_link_libraries(
    ${target}
    PUBLIC ${ARG_PUBLIC}
    PRIVATE ${ARG_PRIVATE})
  elastimate_compile_options(${target})
  install(TARGETS ${target} EXPORT elastimateTargets)
  foreach(header ${ARG_PUBLIC_HEADERS})
    cmake_path(GET header PARENT_PATH folder)
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/elastimate/${component}/${folder})
  endforeach()
endfunction()

# elastimate_add_module(<target> SOURCES ... LIBRARIES ...)
#
# A shared library that is loaded when it is used, because what it links takes long to load (core/package/dynamic_module.h).
function(elastimate_add_module target)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_library(${target} MODULE ${ARG_SOURCES})
  set_target_properties(${target} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${ELASTIMATE_BUILT_PACKAGE_FILES})
  target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/include)
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES})
  elastimate_compile_options(${target})
  install(TARGETS ${target} DESTINATION ${ELASTIMATE_PACKAGE_FILES} COMPONENT package_files)
endfunction()

# elastimate_add_helper(<target> SOURCES ... LIBRARIES ...)
#
# A program that a library starts in a process of its own (io/helper/mesh_program.h).
function(elastimate_add_helper target)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${target} ${ARG_SOURCES})
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${ELASTIMATE_BUILT_PACKAGE_FILES}
                                             INSTALL_RPATH $ORIGIN/..)
  target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/include)
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES})
  target_link_options(${target} PRIVATE LINKER:--as-needed)  # It starts for each file.
  elastimate_compile_options(${target})
  install(TARGETS ${target} RUNTIME DESTINATION ${ELASTIMATE_PACKAGE_FILES} COMPONENT package_files)
endfunction()

function(elastimate_install_package)
  include(CMakePackageConfigHelpers)
  set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/elastimate)
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/elastimate-config.cmake.in
                                ${PROJECT_BINARY_DIR}/elastimate-config.cmake INSTALL_DESTINATION ${destination})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/elastimate-config-version.cmake
                                   COMPATIBILITY SameMinorVersion)
  install(
    FILES ${PROJECT_BINARY_DIR}/elastimate-config.cmake
          ${PROJECT_BINARY_DIR}/elastimate-config-version.cmake
          ${PROJECT_SOURCE_DIR}/cmake/ElastimateDependencies.cmake
          ${PROJECT_SOURCE_DIR}/cmake/FindCHOLMOD.cmake
          ${PROJECT_SOURCE_DIR}/cmake/FindLibCSV.cmake
    DESTINATION ${destination})
  install(EXPORT elastimateTargets NAMESPACE elastimate:: DESTINATION ${destination})
endfunction()
