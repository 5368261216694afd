// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include <taut/impl/dist/processes/environment.hpp>

namespace taut::dist::impl
{

/// A vertex of another process: its place there.
struct remote_place
{
    std::size_t rank;
    std::int64_t place;
};

/// Copies of values at vertices that other processes own, by a star forest of PETSc.
class vertex_exchange
{
public:
    vertex_exchange() = default;

    /// Collective. own: vertices owned here; from: where each copy comes from.
    vertex_exchange(const communicator& all, std::size_t own, const std::vector<remote_place>& from)
    {
        std::vector<PetscSFNode> nodes;
        nodes.reserve(from.size());
        for (const auto& f : from) nodes.push_back({static_cast<PetscInt>(f.rank), static_cast<PetscInt>(f.place)});
        PetscSF made = nullptr;
        require(PetscSFCreate(all.raw(), &made));
        forest_ = std::shared_ptr<std::remove_pointer_t<PetscSF>>(made, destroy);
        require(PetscSFSetGraph(made, static_cast<PetscInt>(own), static_cast<PetscInt>(nodes.size()), nullptr,
                                PETSC_COPY_VALUES, nodes.data(), PETSC_COPY_VALUES));
        require(PetscSFSetUp(made));
    }

    /// Collective. Copies `width` numbers each: of owned vertices to their copies.
    template <class T>
    void copy(const T* own, T* copies, int width = 1) const
    {
        const unit type(base_of<T>(), width);
        require(PetscSFBcastBegin(forest_.get(), type.handle, own, copies, MPI_REPLACE));
        require(PetscSFBcastEnd(forest_.get(), type.handle, own, copies, MPI_REPLACE));
    }

    /// The same where the copies stand behind the owned ones, `own` of them.
    template <class T>
    void update(std::vector<T>& x, std::size_t own, int width = 1) const
    {
        const auto begin = own * static_cast<std::size_t>(width);
        copy(x.data(), x.data() + begin, width);
    }

private:
    struct unit
    {
        MPI_Datatype handle = MPI_DATATYPE_NULL;
        unit(MPI_Datatype base, int width)
        {
            MPI_Type_contiguous(width, base, &handle);
            MPI_Type_commit(&handle);
        }
        unit(const unit&) = delete;
        unit& operator=(const unit&) = delete;
        ~unit() { MPI_Type_free(&handle); }
    };

    template <class T>
    static MPI_Datatype base_of()
    {
        if constexpr (std::is_same_v<T, double>)
            return MPI_DOUBLE;
        else if constexpr (std::is_same_v<T, std::int64_t>)
            return MPI_INT64_T;
        else if constexpr (std::is_same_v<T, std::int32_t>)
            return MPI_INT32_T;
        else
        {
            static_assert(sizeof(T) == 1, "a number, or a byte");
            return MPI_CHAR;
        }
    }

    static void destroy(PetscSF forest)
    {
        PetscBool over = PETSC_FALSE;
        PetscFinalized(&over);
        if (!over) PetscSFDestroy(&forest);
    }

    std::shared_ptr<std::remove_pointer_t<PetscSF>> forest_;
};

} // namespace taut::dist::impl
