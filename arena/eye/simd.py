"""SIMD of four channels: numba leaves LLVM's vectoriser of straight-line code off, so it is spelt out."""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

_QUAD = ir.VectorType(ir.FloatType(), 4)


def _at(context: Any, builder: Any, kind: Any, array: Any, item: Any) -> Any:
    """Point to the four floats of an item."""
    data = context.make_array(kind)(context, builder, array).data
    # Twice shifted, as the pointer is to floats and an item has four.
    where = builder.gep(data, [builder.shl(item, ir.Constant(ir.IntType(64), 2))])
    return builder.bitcast(where, _QUAD.as_pointer())


def _splat(builder: Any, value: Any) -> Any:
    nothing, word = ir.Constant(_QUAD, ir.Undefined), ir.IntType(32)
    # What the other lanes hold does not matter: the shuffle takes lane 0 four times.
    one = builder.insert_element(nothing, value, ir.Constant(word, 0))
    return builder.shuffle_vector(one, nothing, ir.Constant(ir.VectorType(word, 4), [0] * 4))


@intrinsic
def add_three(
    _typing: Any, items: types.Array, first: Any, a: Any, b: Any, c: Any, out: types.Array, item: Any
) -> Any:
    """Add a items[first] + b items[first + 1] + c items[first + 2] to out[item]; an item is four float32."""

    def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind, _, _, _, _, out_kind, _ = signature.args
        items, first, *weights, out, item = arguments
        product = ir.FunctionType(_QUAD, [_QUAD] * 3)
        multiply_add = cgutils.get_or_insert_function(builder.module, product, "llvm.fma.v4f32")
        where = _at(context, builder, out_kind, out, item)
        total = builder.load(where, align=4)
        # One rounding for both on every machine: a processor without the instruction gets the same bits, but
        # slowly. Aligned to four bytes only, since numpy promises no more of a float32 array.
        for step, weight in enumerate(weights):
            one = _at(context, builder, kind, items, builder.add(first, ir.Constant(ir.IntType(64), step)))
            total = builder.call(multiply_add, [_splat(builder, weight), builder.load(one, align=4), total])
        builder.store(total, where, align=4)
        return context.get_dummy_value()

    number = types.float32
    return types.none(items, types.int64, number, number, number, out, types.int64), codegen
