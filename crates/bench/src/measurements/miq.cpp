// A seamless map by mixed-integer quadrangulation as libigl has it, for `seamstress-bench miq`: `miq MESH MAP.obj`.
//
// A smooth cross field, one face held (`nrosy`), and its integration with no coordinate rounded and five rounds of stiffening, as by default.
// The last line of the output has the CPU seconds of both, as JSON. Needs libigl 2.5, CoMISo, gmm++ and Eigen:
//
//   g++ -O2 -DNDEBUG -DINCLUDE_TEMPLATES -std=c++17 -Ilibigl/include -I. -ICoMISo -ICoMISo/ext/gmm-4.2/include \
//     -I/usr/include/eigen3 miq.cpp CoMISo/Solver/{EigenLDLTSolver,MISolver,ConstrainedSolver,GMM_Tools}.cc -o miq -lblas
#include <igl/barycenter.h>
#include <igl/copyleft/comiso/miq.h>
#include <igl/copyleft/comiso/nrosy.h>
#include <igl/local_basis.h>
#include <igl/read_triangle_mesh.h>
#include <igl/rotate_vectors.h>
#include <igl/writeOBJ.h>
#include <cstdio>
#include <ctime>

static double now() { return double(std::clock()) / CLOCKS_PER_SEC; }

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  Eigen::MatrixXd V, X1, X2, UV, B1, B2, B3;
  Eigen::MatrixXi F, FUV;
  if (!igl::read_triangle_mesh(argv[1], V, F)) return 1;
  const double start = now();
  Eigen::VectorXi held(1);
  held << 0;
  Eigen::MatrixXd along = V.row(F(0, 1)) - V.row(F(0, 0));
  Eigen::VectorXd singular;
  igl::copyleft::comiso::nrosy(V, F, held, along, Eigen::VectorXi(), Eigen::VectorXd(), Eigen::MatrixXd(), 4, 0.5, X1, singular);
  igl::local_basis(V, F, B1, B2, B3);
  X2 = igl::rotate_vectors(X1, Eigen::VectorXd::Constant(1, igl::PI / 2), B1, B2);
  const double field = now();
  igl::copyleft::comiso::miq(V, F, X1, X2, UV, FUV, 50, 5, false, 5, 5, false, false);
  const double end = now();
  std::printf("{\"field\": %.3f, \"integration\": %.3f}\n", field - start, end - field);
  Eigen::MatrixXd none(0, 3);
  Eigen::MatrixXi none_faces(0, 3);
  return igl::writeOBJ(argv[2], V, F, none, none_faces, UV, FUV) ? 0 : 1;
}
