// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/dist/free_rows.hpp>
#include <taut/impl/dist/solver_params.hpp>
#include <taut/impl/dist/space.hpp>

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
        if (setups_ == 0 && safety_ == 0 && !factors_) require_used();
        ++setups_;
    }

    /// Collective. out = M v at owned vertices.
    void apply(const free_rows& rows, const numbers& v, numbers& out)
    {
        if (rows.total() == 0) return std::fill(out.begin(), out.end(), 0.0);
        rows.gather(v, in_);
        require(PCApply(pc_.get(), in_.get(), out_.get()));
        rows.scatter(out_, out);
    }

    int setups() const { return setups_; }       ///< changes of the matrix
    int fallbacks() const { return fallbacks_; } ///< how often a safer one was needed

private:
    static constexpr int last_ = 2; ///< the block diagonal

    /// Of options, so that those of a program are not ours.
    std::string prefix() const { return "taut_" + std::to_string(safety_) + (factors_ ? "_lu_" : "_"); }

    /// Collective. Throws parameter_error for options of the user that nothing has asked for; those of levels are left
    /// to meshes that have some.
    void require_used()
    {
        PetscInt count = 0;
        char **names = nullptr, **values = nullptr;
        require(PetscOptionsLeftGet(nullptr, &count, &names, &values));
        std::string idle;
        for (PetscInt k = 0; k < count; ++k)
        {
            const std::string name = names[k], own = prefix();
            if (!name.starts_with(own) || name.starts_with(own + "mg_")) continue;
            const std::string word = '-' + name.substr(own.size());
            if ((params_.options + ' ').find(word + ' ') != std::string::npos) idle = word;
        }
        require(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
        if (all_.any(!idle.empty()))
            throw parameter_error("solver.options", "PETSc's preconditioner has no option " + idle + "; leave it out");
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
        if (params_.preconditioner == preconditioner::block_jacobi && !params_.options.empty())
            throw parameter_error("solver.options", "the block diagonal has none; leave them out");
        const std::string prefix = this->prefix();
        require(PetscOptionsPrefixPush(nullptr, prefix.c_str()));
        const auto inserted = PetscOptionsInsertString(nullptr, options().c_str());
        require(PetscOptionsPrefixPop(nullptr));
        require(PCSetOptionsPrefix(made, prefix.c_str()));
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
        // Errors of PETSc end on all processes alike.
        bool failed = PCSetOperators(pc_.get(), rows.matrix(), rows.matrix()) != 0 || PCSetUp(pc_.get()) != 0;
        PCFailedReason why = PC_NOERROR;
        if (!failed) failed = PCGetFailedReason(pc_.get(), &why) != 0 || why != PC_NOERROR;
        if (all_.any(failed)) return false;
        rows.gather(tried, in_);
        PetscScalar product = 0, size = 0;
        failed = PCApply(pc_.get(), in_.get(), out_.get()) != 0 || VecDot(in_.get(), out_.get(), &product) != 0 ||
                 VecDot(in_.get(), in_.get(), &size) != 0;
        return !all_.any(failed || !std::isfinite(product) || (!(product > 0) && size > 0));
    }

    communicator all_;
    solver_params params_;
    petsc_preconditioner pc_;
    petsc_vector in_, out_;
    bool factors_ = false;
    int safety_ = 0, setups_ = 0, fallbacks_ = 0;
};

} // namespace taut::dist::impl
