/// Eigen's decompositions of large matrices, compiled once: each takes seconds of every file that has them compiled.
#pragma once

#include "tests/support/dense_wing.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

extern template Eigen::EigenSolver<Eigen::MatrixXd>&
Eigen::EigenSolver<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&, bool);
extern template Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>&
Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&,
                                                        int);
extern template Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>&
Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>::compute(const Eigen::MatrixXd&,
                                                                   const Eigen::MatrixXd&, int);
extern template void Eigen::PartialPivLU<Eigen::MatrixXd>::compute();
extern template void
Eigen::PartialPivLU<Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>>::compute();
extern template void Eigen::PartialPivLU<
    Eigen::Matrix<wingspread::oracle::Quad, Eigen::Dynamic, Eigen::Dynamic>>::compute();
