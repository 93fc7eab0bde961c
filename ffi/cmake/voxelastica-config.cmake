# voxelastica::voxelastica is the C library, voxelastica::cxx the C++17 classes (headers and a static library).
get_filename_component(_voxelastica_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
include(CMakeFindDependencyMacro)
find_dependency(Threads)

if(NOT TARGET voxelastica::voxelastica)
  add_library(voxelastica::voxelastica SHARED IMPORTED)
  set_target_properties(
    voxelastica::voxelastica
    PROPERTIES IMPORTED_LOCATION
               "${_voxelastica_prefix}/lib/${CMAKE_SHARED_LIBRARY_PREFIX}voxelastica${CMAKE_SHARED_LIBRARY_SUFFIX}"
               IMPORTED_NO_SONAME TRUE
               INTERFACE_INCLUDE_DIRECTORIES "${_voxelastica_prefix}/include")

  add_library(voxelastica::cxx STATIC IMPORTED)
  set_target_properties(
    voxelastica::cxx
    PROPERTIES IMPORTED_LOCATION "${_voxelastica_prefix}/lib/libvoxelastica_cxx.a"
               INTERFACE_INCLUDE_DIRECTORIES "${_voxelastica_prefix}/include"
               INTERFACE_COMPILE_FEATURES cxx_std_17
               INTERFACE_LINK_LIBRARIES "Threads::Threads;${CMAKE_DL_LIBS};m")
endif()
unset(_voxelastica_prefix)
