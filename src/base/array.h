/* base/array.h: a growable array of any type, by macros. `VL_ARRAY(T)` is the type; a zeroed
 * array is empty.
 *     VL_ARRAY(int) a = {0};
 *     int *p = VL_PUSH(ctx, &a);
 *     if (p)
 *       *p = 3;
 *     for (size_t i = 0; i < a.count; i++) ... */
#ifndef BASE_ARRAY_H
#define BASE_ARRAY_H

#include "base/context.h"

#define VL_ARRAY(T)         \
  struct {                  \
    T *items;               \
    size_t count, capacity; \
  }

/* Pointer to a new zeroed element at the end, or null if memory is exhausted (the array is then
 * unchanged). */
#define VL_PUSH(context, array) \
  (VL_RESERVE_ZERO((context), array, 1) ? &(array)->items[(array)->count++] : NULL)
/* Pointer to a new element at an index, not zeroed; the elements from there on move up. */
#define VL_INSERT(context, array, at)                                                \
  (VL_PUSH((context), (array))                                                       \
       ? vl_array_open((array)->items, (array)->count, sizeof *(array)->items, (at)) \
       : NULL)
/* Reserves capacity for n more elements, which are not zeroed. False if memory is exhausted. */
#define VL_RESERVE(context, array, n)                                                       \
  vl_array_reserve((context), (void **)&(array)->items, &(array)->capacity, (array)->count, \
                   sizeof *(array)->items, (n))
/* The same, zeroed. */
#define VL_RESERVE_ZERO(context, array, n)                                               \
  vl_array_grow((context), (void **)&(array)->items, &(array)->capacity, (array)->count, \
                sizeof *(array)->items, (n))
#define VL_ARRAY_FREE(context, array)                         \
  (vl_free((context), (array)->items), (array)->items = NULL, \
   (array)->count = (array)->capacity = 0)

/* A loop over the elements of an array, which must not grow; item: what its body calls one. */
#define VL_EACH_ITEM(T, item, array) \
  for (T *item = (array)->items; (size_t)(item - (array)->items) < (array)->count; item++)

/* Reserves capacity for `more` elements after `count`. vl_array_grow zeroes them. */
bool vl_array_reserve(vlContext *context, void **items, size_t *capacity, size_t count,
                      size_t size, size_t more);
bool vl_array_grow(vlContext *context, void **items, size_t *capacity, size_t count,
                   size_t size, size_t more);
/* Moves the elements from `at` to the last but one up by one. Returns the address of `at`. */
void *vl_array_open(void *items, size_t count, size_t size, size_t at);

#endif
