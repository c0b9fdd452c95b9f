"""The models the waves are judged against; they share no code with them."""
