//! Pictures of recordings and databases: PNG and EXR sequences, plots.
