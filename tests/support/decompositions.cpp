#include "tests/support/decompositions.hpp"

template Eigen::EigenSolver<Eigen::MatrixXd>&
Eigen::EigenSolver<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&, bool);
template Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>&
Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&,
                                                        int);
template Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>&
Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>::compute(const Eigen::MatrixXd&,
                                                                   const Eigen::MatrixXd&, int);
template void Eigen::PartialPivLU<Eigen::MatrixXd>::compute();
template void
Eigen::PartialPivLU<Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>>::compute();
template void Eigen::PartialPivLU<
    Eigen::Matrix<wingspread::oracle::Quad, Eigen::Dynamic, Eigen::Dynamic>>::compute();
