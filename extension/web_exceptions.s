# The engine's web templates are built without C++ exceptions, so that they have no tag to throw with. The library
# brings its own, with what of the C++ runtime throws and catches by it: no exception leaves the library.
	.tagtype __cpp_exception i32
	.globl __cpp_exception
	.hidden __cpp_exception
__cpp_exception:
