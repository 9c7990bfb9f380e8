/// Eigen's decompositions of symmetric matrices, compiled once for distributions and montecarlo, in copula.cpp: each takes
/// seconds of every file that compiles it. core, which does not include this, has its own.
#pragma once

#include <Eigen/Eigenvalues>

extern template Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>&
Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&,
                                                        int);
extern template Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>&
Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>::compute(const Eigen::MatrixXd&,
                                                                   const Eigen::MatrixXd&, int);
