// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <taut/dist.hpp>
#include <taut/impl/dist/shape/free_rows.hpp>
#include <taut/impl/dist/shape/space.hpp>

namespace taut::dist::impl
{

/// Preconditioner of a matrix that changes, by algebraic multigrid of PETSc. After each change it is tried: where it
/// fails, or is not positive, a safer one takes its place, at last the block diagonal.
class algebraic_multigrid
{
public:
    using numbers = std::vector<double>;

    algebraic_multigrid(communicator all, solver_params params) : all_(std::move(all)), params_(std::move(params)) {}

    /// Collective. For other rows: all is made anew.
    void forget() { pc_ = {}; }

    /// Collective. From now on systems are solved by factorisation, for want of anything better; false where PETSc
    /// lacks MUMPS, or that is so already.
    bool use_factors()
    {
        MatSolverType type = MATSOLVERMUMPS;
        PetscBool package = PETSC_FALSE, found = PETSC_FALSE;
        if (factors_ || MatSolverTypeGet(type, MATMPIAIJ, MAT_FACTOR_LU, &package, &found, nullptr) != 0 || !found)
            return false;
        factors_ = true;
        pc_ = {};
        return true;
    }

    /// Whether it is to be made anew for the matrix as it is now; asked once after each change, with the same answer on
    /// all processes. A set-up costs as much as some seven products, so it is kept as long as systems take few more of
    /// them than right after it was made.
    bool due()
    {
        constexpr int most = 5, slack = 4; // changes; products
        const int last = std::exchange(applied_, 0);
        if (!pc_ || factors_) return true;
        if (first_ < 0) first_ = last;
        return kept_++ >= most || last > first_ + slack;
    }

    /// Collective. rows: the matrix. near: positions, D a vertex with a row, whose rigid motions hardly strain; or
    /// none. tried: numbers at owned vertices to try it with.
    void refresh(const free_rows& rows, int dimension, const numbers& near, const numbers& tried)
    {
        if (rows.total() == 0) return;
        if (!pc_)
        {
            safety_ = 0;
            make(rows, dimension, near);
        }
        while (!works(rows, tried))
        {
            if (++safety_ > last_) throw backend_error("PETSc: no preconditioner of the Newton system is positive");
            ++fallbacks_;
            make(rows, dimension, near);
        }
        ++setups_;
        first_ = -1;
        kept_ = 0;
        made_ = made_ || (safety_ == 0 && !factors_);
    }

    /// Collective. out = M v at owned vertices.
    void apply(const free_rows& rows, const numbers& v, numbers& out)
    {
        if (rows.total() == 0) return std::fill(out.begin(), out.end(), 0.0);
        ++applied_;
        rows.gather(v, in_);
        require(PCApply(pc_.get(), in_.get(), out_.get()));
        rows.scatter(out_, out);
    }

    /// Names among the options of the parameters that PETSc made no use of; none before the first system.
    std::vector<std::string> unused() const
    {
        std::vector<std::string> names;
        std::istringstream words(params_.options);
        for (std::string word; made_ && words >> word;)
        {
            if (word.size() < 2 || word[0] != '-' || std::isalpha(static_cast<unsigned char>(word[1])) == 0) continue;
            PetscBool used = PETSC_FALSE;
            require(PetscOptionsUsed(nullptr, (prefix(0, false) + word.substr(1)).c_str(), &used));
            if (!used) names.push_back(std::move(word));
        }
        return names;
    }

    int setups() const { return setups_; }       ///< changes of the matrix
    int fallbacks() const { return fallbacks_; } ///< how often a safer one was needed

private:
    static constexpr int last_ = 2; ///< the block diagonal

    static std::string prefix(int safety, bool factors)
    {
        return "taut_" + std::to_string(safety) + (factors ? "_lu_" : "_");
    }

    /// Options of PETSc, by what one may trust. Chebyshev's bounds are estimated for each new matrix, with a margin:
    /// the first ones turn the smoother indefinite later.
    std::string options() const
    {
        if (factors_ && safety_ == 0) return "-pc_type lu -pc_factor_mat_solver_type mumps";
        if (safety_ == last_ || params_.preconditioner == preconditioner::block_jacobi) return "-pc_type pbjacobi";
        const std::string gamg = "-pc_type gamg -pc_gamg_use_sa_esteig 0 -pc_gamg_reuse_interpolation 1 "
                                 "-pc_gamg_threshold -1 -mg_levels_ksp_chebyshev_esteig 0,0.1,0,";
        if (safety_ == 1) return gamg + "1.5";
        if (params_.preconditioner == preconditioner::gamg) return gamg + "1.2 " + params_.options;
        return "-pc_type hypre -pc_hypre_type boomeramg -pc_hypre_boomeramg_coarsen_type HMIS "
               "-pc_hypre_boomeramg_interp_type ext+i -pc_hypre_boomeramg_P_max 4 -pc_hypre_boomeramg_agg_nl 1 "
               "-pc_hypre_boomeramg_nodal_coarsen 4 -pc_hypre_boomeramg_strong_threshold 0.5 "
               "-pc_hypre_boomeramg_relax_type_all symmetric-SOR/Jacobi " +
               params_.options;
    }

    void make(const free_rows& rows, int dimension, const numbers& near)
    {
        in_ = rows.make_vector();
        out_ = rows.make_vector();
        PC made = nullptr;
        require(PCCreate(all_.raw(), &made));
        pc_ = petsc_preconditioner(made);
        // Under a prefix of its own, so that the options of a program are not ours.
        const std::string named = prefix(safety_, factors_);
        require(PetscOptionsPrefixPush(nullptr, named.c_str()));
        const auto inserted = PetscOptionsInsertString(nullptr, options().c_str());
        require(PetscOptionsPrefixPop(nullptr));
        require(PCSetOptionsPrefix(made, named.c_str()));
        require(PCSetOperators(made, rows.matrix(), rows.matrix()));
        const bool taken = inserted == 0 && PCSetFromOptions(made) == 0;
        if (!taken && !params_.options.empty() && safety_ == 0)
            throw parameter_error("solver.options", "PETSc does not understand '" + params_.options + "'");
        if (!taken) throw backend_error("PETSc: it has no preconditioner for '" + options() + "'");
        PCType type = nullptr;
        require(PCGetType(made, &type));
        if (dimension > 1 && !near.empty() && type && std::string(type) == PCGAMG)
            keep_rigid_motions(rows, dimension, near);
    }

    void keep_rigid_motions(const free_rows& rows, int dimension, const numbers& near)
    {
        const auto x = rows.make_vector();
        require(VecSetBlockSize(x.get(), dimension));
        rows.gather(near, x);
        MatNullSpace motions = nullptr;
        require(MatNullSpaceCreateRigidBody(x.get(), &motions));
        const petsc_null_space owner(motions);
        require(MatSetNearNullSpace(rows.matrix(), motions));
    }

    /// Whether it can be set up, and v'M v is positive.
    bool works(const free_rows& rows, const numbers& tried)
    {
        // Errors of PETSc mostly end on all processes alike.
        bool failed = PCSetOperators(pc_.get(), rows.matrix(), rows.matrix()) != 0 || PCSetUp(pc_.get()) != 0;
        PCFailedReason why = PC_NOERROR;
        if (!failed) failed = PCGetFailedReason(pc_.get(), &why) != 0 || why != PC_NOERROR;
        if (all_.any_failed(failed, "PETSc: setting up a preconditioner")) return false;
        rows.gather(tried, in_);
        PetscScalar product = 0, size = 0;
        failed = PCApply(pc_.get(), in_.get(), out_.get()) != 0 || VecDot(in_.get(), out_.get(), &product) != 0 ||
                 VecDot(in_.get(), in_.get(), &size) != 0;
        return !all_.any_failed(failed || !std::isfinite(product) || (!(product > 0) && size > 0),
                                "PETSc: applying a preconditioner");
    }

    communicator all_;
    solver_params params_;
    petsc_preconditioner pc_;
    petsc_vector in_, out_;
    bool factors_ = false, made_ = false; ///< made: once with the options of the parameters
    int safety_ = 0, setups_ = 0, fallbacks_ = 0;
    int applied_ = 0, first_ = -1, kept_ = 0; ///< products since the last change, right after the set-up; changes since
};

} // namespace taut::dist::impl
