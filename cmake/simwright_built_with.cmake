# simwright_built_with(TARGET): compiles NAME=VERSION|NAME=VERSION... of the compiler and of the
# libraries into TARGET as SIMWRIGHT_BUILT_WITH, for `simwright version`.
function(simwright_built_with target)
  set(torch_version ${Torch_VERSION})
  if(SIMWRIGHT_TORCH_ROOT)
    file(STRINGS ${SIMWRIGHT_TORCH_ROOT}/include/torch/csrc/api/include/torch/version.h lines
         REGEX "define TORCH_VERSION \"")
    string(REGEX REPLACE ".*\"(.*)\".*" "\\1" torch_version "${lines}")
  endif()
  file(STRINGS ${MUJOCO_HEADER}/mujoco/mujoco.h mujoco_line REGEX "define mjVERSION_HEADER")
  string(REGEX REPLACE ".*mjVERSION_HEADER ([0-9])([0-9])([0-9]+).*" "\\1.\\2.\\3" mujoco_version
         "${mujoco_line}")
  get_filename_component(openblas_name "${SIMWRIGHT_OPENBLAS}" NAME)
  set(simwright_mpi_version)
  if(simwright_mpi_link)
    set(simwright_mpi_version ${MPI_C_VERSION})
  endif()
  set(pairs
    "compiler=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
    "build=${CMAKE_BUILD_TYPE}, ${CMAKE_SYSTEM_NAME} ${CMAKE_SYSTEM_PROCESSOR}"
    "assimp=${assimp_VERSION}"
    "Bullet=${bullet_VERSION}, double precision"
    "Ceres=${Ceres_VERSION}"
    "CGAL=${CGAL_VERSION}"
    "CLI11=${CLI11_VERSION}"
    "cpp-httplib=${cpp_httplib_VERSION}"
    "curl=${CURL_VERSION_STRING}"
    "Draco=${draco_VERSION}"
    "Eigen=${Eigen3_VERSION}"
    "Embree=${embree_VERSION}"
    "HDF5=${hdf5_VERSION}"
    "libtorch=${torch_version}"
    "libzip=${libzip_VERSION}"
    "MPI=${simwright_mpi_version}"
    "MuJoCo=${mujoco_version}"
    "nlohmann-json=${nlohmann_json_VERSION}"
    "OpenBLAS=${openblas_name}"
    "OpenCV=${OpenCV_VERSION}"
    "spdlog=${spdlog_VERSION}"
    "tinyxml2=${tinyxml2_VERSION}"
    "urdfdom=${urdfdom_VERSION}")
  list(FILTER pairs EXCLUDE REGEX "=$")
  list(JOIN pairs "|" text)
  target_compile_definitions(${target} PRIVATE "SIMWRIGHT_BUILT_WITH=\"${text}\"")
endfunction()
